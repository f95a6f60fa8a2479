//! Shows a point light in a room: the point-shadow chapter of graphics tutorials, without its seams
//! and without its acne.
//!
//! `cargo run --example point_room -- [FOLDER] --frames N` moves the light over N images, draws the
//! same moment with the library's filter and with the two classic ones, and lays the six faces of
//! the light's map out flat, into `target/point_room` or the folder named. The scene is that of
//! <https://learnopengl.com/Advanced-Lighting/Shadows/Point-Shadows>: a room of ten by ten by ten
//! metres with five cubes in it.
//!
//! ```text
//! room.rs          walls, cubes, and where the light hangs
//! lamp.rs          the light's shadows, and the images that they are in
//! line.rs          what a frame cost, in one line
//! room.wgsl        the fragment stage
//! ../support       meshes and Blinn-Phong
//! ```

mod lamp;
mod line;
mod room;

use std::error::Error;
use std::path::PathBuf;
use std::process::ExitCode;

use clap::Parser;
use example_support::{arguments, picture};
use glam::Vec3;
use shadow_support::gpu::{Gpu, GpuRequest};
use wgpu_shadows::{Filter, ShadowCaster, debug::DebugImage};

use lamp::Lamp;
use room::Room;

/// Draws a room with a point light that moves.
#[derive(Parser)]
struct Arguments {
    /// Sets the folder for the images.
    #[arg(default_value = "target/point_room")]
    folder: PathBuf,
    /// Sets the number of images of the moving light.
    #[arg(long, default_value_t = 4, value_parser = clap::value_parser!(u32).range(1..=1000))]
    frames: u32,
}

/// Is the width and height of the images.
const SIZE: [u32; 2] = [960, 540];

/// Is the number of texels per side of a face in the cross.
const CROSS_CELL: u32 = 256;

fn main() -> ExitCode {
    arguments::run("point_room", run)
}

fn run(arguments: Arguments) -> Result<(), Box<dyn Error>> {
    let gpu = Gpu::new(&GpuRequest::default())?;
    picture::make_folder(&arguments.folder)?;
    let room = Room::new(&gpu.device)?;
    let cubes = room.cubes();
    let save = |name: &str, pixels: &[u8], size| {
        let path = arguments.folder.join(name);
        picture::save(&path, pixels, size).map(|()| println!("{}", path.display()))
    };

    println!("The lamp moves; the cubes cast, and the walls only receive.");
    let mut lamp = Lamp::new(&gpu, Filter::default())?;
    for frame in 0..arguments.frames {
        let place = room::lamp_place(frame, arguments.frames);
        let pixels = lamp.draw(&gpu, &room, place, &cubes)?;
        save(&format!("frame-{frame:03}.png"), &pixels, SIZE)?;
        println!("    {}", line::of(lamp.report()));
    }
    let place = room::lamp_place(arguments.frames - 1, arguments.frames);
    lamp.draw(&gpu, &room, place, &cubes)?;
    println!("the last frame once more, with nothing moved");
    println!("    {}", line::of(lamp.report()));

    println!("\nThe lamp in the middle, under three filters.");
    for (name, filter) in [
        ("filter-default.png", Filter::default()),
        ("filter-grid.png", Filter::DirectionGrid { radius: 0.1 }),
        ("filter-star.png", Filter::DirectionStar { radius: 0.04 }),
    ] {
        let mut lamp = Lamp::new(&gpu, filter)?;
        let pixels = lamp.draw(&gpu, &room, Vec3::ZERO, &cubes)?;
        save(name, &pixels, SIZE)?;
        let looks = filter.texture_instructions();
        println!("    {filter:?}: {looks} texture instructions a pixel");
    }

    println!("\nThe map of the lamp in the middle, with the walls in it as the tutorial has them.");
    let everything: Vec<&dyn ShadowCaster> = room.cubes_and_walls();
    lamp.record_for_all_of_space(&gpu, &room, Vec3::ZERO, &everything)?;
    let cross = [4 * CROSS_CELL, 3 * CROSS_CELL];
    let pixels = lamp.draw_map(&gpu, DebugImage::Cross, cross)?;
    save("cross.png", &pixels, cross)?;
    println!("    {}", line::of(lamp.report()));
    let face = [lamp::MAP_SIZE; 2];
    let pixels = lamp.draw_map(&gpu, DebugImage::Layer(5), face)?;
    save("face.png", &pixels, face)?;
    println!("    the face that looks along -z, one pixel a texel");
    Ok(())
}
