//! Starts the program, with its command line.

use std::error::Error;
use std::fmt::Display;
use std::path::PathBuf;
use std::process::ExitCode;

use clap::Parser;
use example_support::arguments;
use winit::dpi::LogicalSize;
use winit::event_loop::{EventLoop, EventLoopProxy};
use winit::window::Window;

use crate::offscreen::{self, Shot};
use crate::settings::Settings;
use crate::state::Request;
use crate::window::{self, App, Arrival};

/// Shows shadows in a window, with every setting beside them.
#[derive(Parser)]
struct Arguments {
    /// Names a glTF file to show.
    file: Option<PathBuf>,
    /// Names a built-in scene: textbook, town, hall, penumbrae, sky or grove.
    #[arg(long)]
    scene: Option<String>,
    /// Sets what the page has behind the # of its address, as key=value&key=value.
    #[arg(long, default_value = "")]
    address: String,
    /// Sets the width and height of the window.
    #[arg(long, num_args = 2, default_values_t = [1400, 800])]
    size: Vec<u32>,
    /// Draws the window into this PNG file instead of showing it.
    #[arg(long)]
    screenshot: Option<PathBuf>,
    /// With --screenshot, casts rays and shows the difference from the truth.
    #[arg(long)]
    truth: bool,
    /// With --screenshot, lets everything move a little before.
    #[arg(long)]
    moving: bool,
}

/// Runs the program.
pub fn main() -> ExitCode {
    arguments::run("viewer", run)
}

fn run(arguments: Arguments) -> Result<(), Box<dyn Error>> {
    let mut address = arguments.address;
    if let Some(scene) = arguments.scene {
        address = format!("scene={scene}&{address}");
    }
    let size = [arguments.size[0], arguments.size[1]].map(|side| side.clamp(320, 8192));
    if let Some(path) = &arguments.screenshot {
        offscreen::save(&Shot {
            path,
            size,
            address: &address,
            file: arguments.file.as_deref(),
            truth: arguments.truth,
            is_moving: arguments.moving,
        })?;
        println!("{}", path.display());
        return Ok(());
    }
    let attributes = Window::default_attributes()
        .with_title("wgpu-shadows")
        .with_inner_size(LogicalSize::new(size[0], size[1]));
    Ok(window::run(
        address,
        arguments.file.map(Request::Path),
        attributes,
    )?)
}

/// Runs the loop until the window is closed.
pub fn run_app(event_loop: EventLoop<Arrival>, mut app: App) -> Result<(), String> {
    event_loop
        .run_app(&mut app)
        .map_err(|error| format!("the window failed: {error}"))?;
    app.failure.map_or(Ok(()), Err)
}

/// Runs what makes the device to its end.
pub fn spawn(work: impl Future<Output = ()>) {
    pollster::block_on(work);
}

/// Does what a page does before its first frame: nothing.
pub fn before_run(_: &EventLoopProxy<Arrival>) {}

/// Writes a message for whoever started the program.
pub fn log(message: &str) {
    eprintln!("viewer: {message}");
}

/// Copies a text where egui does not: nowhere.
pub fn copy(_: &str) {}

/// Keeps the settings where a page does: nowhere.
pub fn keep_address(_: &Settings) {}

/// Returns what to do where nothing can draw to the window.
pub fn no_adapter(error: &dyn Display) -> String {
    format!(
        "No graphics driver was found that can draw to this window ({error}).\n\n\
         On Debian and Ubuntu, a software one comes with\n\
         apt-get install mesa-vulkan-drivers\n\
         for Vulkan, or with\n\
         apt-get install libegl1 libgl1-mesa-dri\n\
         for OpenGL. Elsewhere, install the driver of your GPU's maker. The variable WGPU_BACKEND, \
         if it is set, must name a backend that the driver has."
    )
}
