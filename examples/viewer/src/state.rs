//! Holds what the panels change, and what they ask for.

use crate::scene;
use crate::settings::Settings;

/// Holds the state of the viewer beside the device.
pub struct State {
    pub settings: Settings,
    /// Is the time in seconds of what moves.
    pub time: f32,
    /// States that what moves by itself does so.
    pub is_moving: bool,
    /// States that the sun goes its way.
    pub day_passes: bool,
    /// Is the hour of the day, 6..=18, as last set.
    pub hour: f32,
    /// Is the side whose settings the panel shows: 0 is left.
    pub edited_side: usize,
    pub is_help_open: bool,
    pub messages: Vec<String>,
    pub requests: Vec<Request>,
    /// States that the picture changes from frame to frame, for one that may then be coarser.
    pub is_in_motion: bool,
    /// Is the factor, at most 1, by which the picture is coarser while it is in motion.
    pub motion_scale: f32,
}

/// Is what a panel asks for.
#[derive(Clone, Debug, PartialEq)]
pub enum Request {
    /// Shows a built-in scene.
    Scene(String),
    /// Casts the rays of the truth.
    Truth,
    /// Stops casting.
    StopTruth,
    /// Saves a picture of the window.
    Screenshot,
    /// Opens the file with these bytes.
    #[cfg(target_arch = "wasm32")]
    File { name: String, bytes: Vec<u8> },
    /// Opens the file at a path, with what lies beside it.
    #[cfg(not(target_arch = "wasm32"))]
    Path(std::path::PathBuf),
}

impl State {
    pub fn new(settings: Settings) -> Self {
        Self {
            settings,
            time: 0.0,
            is_moving: false,
            day_passes: false,
            hour: 10.0,
            edited_side: 1,
            is_help_open: false,
            messages: Vec::new(),
            requests: Vec::new(),
            is_in_motion: false,
            motion_scale: 1.0,
        }
    }

    /// Tells something in the window, once.
    pub fn tell(&mut self, message: impl Into<String>) {
        let message = message.into();
        if !self.messages.contains(&message) {
            self.messages.push(message);
        }
    }

    /// Lets time pass, in seconds.
    pub fn pass_time(&mut self, seconds: f32) {
        if self.is_moving {
            self.time += seconds;
        }
        if self.day_passes {
            self.hour = 6.5 + (self.hour - 6.5 + seconds * 0.4).rem_euclid(11.0);
            self.settings.set_hour(self.hour);
        }
    }

    /// Adapts the picture to the seconds that the last frame took.
    pub fn adapt(&mut self, seconds: f32) {
        if !self.is_in_motion {
            return;
        }
        if seconds > 0.12 {
            self.motion_scale = (self.motion_scale * 0.5).max(0.25);
        } else if seconds < 0.025 {
            self.motion_scale = (self.motion_scale * 2.0).min(1.0);
        }
    }

    /// Returns the number of drawn pixels per pixel of the screen.
    pub fn picture_scale(&self) -> f32 {
        if self.is_in_motion {
            self.settings.picture_scale * self.motion_scale
        } else {
            self.settings.picture_scale
        }
    }

    /// Asks for the built-in scene of this number.
    pub fn request_scene(&mut self, number: usize) {
        if let Some(name) = scene::NAMES.get(number) {
            self.requests.push(Request::Scene((*name).to_owned()));
        }
    }
}
