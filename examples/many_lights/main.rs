//! Shows a hall with a sun, four spot lights and 32 point lights, all with shadows, in one bind
//! group.
//!
//! `cargo run --example many_lights -- [FOLDER] --frames N` draws N images into
//! `target/many_lights` or the folder named, and prints for each frame what its shadows cost. Five
//! of the point lights and one of the spot lights move, and a budget of views per frame refreshes
//! the most important of them first; a light that does not move costs nothing from the second frame
//! on.
//!
//! ```text
//! hall.rs          the hall on the device
//! shadows.rs       the sun, two pools, and one bind group for all of them
//! painter.rs       the images
//! table.rs         what a frame cost
//! ../support       the hall and its lights, meshes and Blinn-Phong
//! ```

mod hall;
mod painter;
mod shadows;
mod table;

use std::error::Error;
use std::path::PathBuf;
use std::process::ExitCode;

use clap::Parser;
use example_support::camera::Camera;
use example_support::hall::{EYE, FIELD_OF_VIEW_RADIANS, TARGET, lights::Lights};
use example_support::{arguments, picture};
use shadow_support::gpu::{Gpu, GpuRequest};

use hall::Hall;
use painter::Painter;
use shadows::Shadows;

/// Draws a hall with many lights.
#[derive(Parser)]
struct Arguments {
    /// Sets the folder for the images.
    #[arg(default_value = "target/many_lights")]
    folder: PathBuf,
    /// Sets the number of images of the moving lights.
    #[arg(long, default_value_t = 3, value_parser = clap::value_parser!(u32).range(1..=1000))]
    frames: u32,
    /// Sets the largest number of views of point lights drawn in a frame; the first frame, in which
    /// all are new, has no limit.
    #[arg(long, default_value_t = 12)]
    budget: u32,
}

/// Is the width and height of the images.
const SIZE: [u32; 2] = [960, 540];

fn main() -> ExitCode {
    arguments::run("many_lights", run)
}

fn run(arguments: Arguments) -> Result<(), Box<dyn Error>> {
    let gpu = Gpu::new(&GpuRequest::default())?;
    picture::make_folder(&arguments.folder)?;
    let hall = Hall::new(&gpu.device)?;
    let casters = hall.casters();
    let mut shadows = Shadows::new(&gpu.device)?;
    let painter = Painter::new(&gpu, shadows.bindings());
    println!("{} meshes cast", casters.len());
    for frame in 0..arguments.frames {
        let lights = Lights::at(frame as f32);
        let camera = Camera::new(EYE, TARGET, FIELD_OF_VIEW_RADIANS, SIZE);
        let budget = (frame > 0).then_some(arguments.budget);
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        shadows.record(&mut encoder, &lights, &camera, &casters, budget)?;
        let pixels = painter.draw(&gpu, encoder, &hall, &lights, &shadows, &camera)?;
        let path = arguments.folder.join(format!("frame-{frame:03}.png"));
        picture::save(&path, &pixels, SIZE)?;
        println!("\n{}\n{}", path.display(), table::of(&shadows));
    }
    Ok(())
}
