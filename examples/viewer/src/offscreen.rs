//! Draws the window into a file, without a window.

use std::path::Path;

use egui::{Pos2, RawInput, Rect, vec2};
use shadow_support::gpu::{Gpu, GpuRequest, TIMESTAMPS};

use crate::scene;
use crate::settings::Show;
use crate::state::Request;
use crate::viewer::{Viewer, save_texture};

const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8Unorm;

/// Is the number of frames after which panels have settled.
const SETTLED: u32 = 6;

/// Describes the picture.
pub struct Shot<'a> {
    pub path: &'a Path,
    pub size: [u32; 2],
    /// Holds settings as the address of the page does.
    pub address: &'a str,
    pub file: Option<&'a Path>,
    /// States that rays are cast, and the difference is shown.
    pub truth: bool,
    pub is_moving: bool,
}

/// Draws the window until it does not change, and saves it.
pub fn save(shot: &Shot<'_>) -> Result<(), String> {
    let gpu = Gpu::new(&GpuRequest {
        optional_features: TIMESTAMPS,
        ..GpuRequest::default()
    })?;
    let target = gpu.target(FORMAT, shot.size, 1);
    let view = target.create_view(&Default::default());
    let mut viewer = Viewer::new(gpu, FORMAT, shot.address)?;
    if let Some(file) = shot.file {
        viewer.open(Ok(scene::from_path(file)?));
    }
    if !shot.address.contains("scale=") {
        viewer.state.settings.picture_scale = 2.0;
    }
    viewer.state.is_moving = shot.is_moving;
    let [width, height] = shot.size.map(|side| side as f32);
    let mut frames = 0;
    let mut still_frames = 0;
    while still_frames < SETTLED {
        let input = RawInput {
            screen_rect: Some(Rect::from_min_size(Pos2::ZERO, vec2(width, height))),
            time: Some(f64::from(frames) * 0.1),
            max_texture_side: Some(viewer.gpu().device.limits().max_texture_dimension_2d as usize),
            ..Default::default()
        };
        viewer.frame(input, &view, shot.size);
        frames += 1;
        if frames == SETTLED {
            viewer.state.is_moving = false;
            if shot.truth {
                viewer.state.requests.push(Request::Truth);
                viewer.state.settings.show = Show::Difference;
            }
        }
        let has_begun = frames > SETTLED + 1;
        still_frames = if has_begun && !viewer.is_casting() {
            still_frames + 1
        } else {
            0
        };
    }
    for message in &viewer.state.messages {
        eprintln!("viewer: {message}");
    }
    save_texture(viewer.gpu(), &target, shot.path)
}
