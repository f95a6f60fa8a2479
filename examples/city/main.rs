//! Shows a town of some thousand buildings under four cascades: what a sun costs, and where its
//! texels go.
//!
//! `cargo run --release --example city -- [FOLDER] --frames N` flies through its streets and over
//! its roofs in N images, written to `target/city` or the folder named, with a table of what each
//! frame's shadows cost; then it draws which cascade covers which pixel of the first frame, and the
//! four maps.
//!
//! ```text
//! town.rs          the town on the device
//! flight.rs        the motion of the camera
//! sun.rs           the sun's shadows, and the images that they are in
//! density.rs       how many texels a pixel covers
//! table.rs         what the frames cost
//! city.wgsl        the fragment stages
//! ../support       the town's plan, meshes, casters and Blinn-Phong
//! ```

mod density;
mod flight;
mod sun;
mod table;
mod town;

use std::error::Error;
use std::path::PathBuf;
use std::process::ExitCode;

use clap::Parser;
use example_support::{arguments, picture};
use shadow_support::gpu::{Gpu, GpuRequest};
use wgpu_shadows::ShadowCaster;

use sun::{Show, Sun};
use table::Table;
use town::Town;

/// Flies through a town with shadows.
#[derive(Parser)]
struct Arguments {
    /// Sets the folder for the images.
    #[arg(default_value = "target/city")]
    folder: PathBuf,
    /// Sets the number of images of the flight.
    #[arg(long, default_value_t = 8, value_parser = clap::value_parser!(u32).range(1..=1000))]
    frames: u32,
}

/// Is the width and height of the images.
const SIZE: [u32; 2] = [960, 540];

/// Is the number of pixels per side of the images of the maps, which have twice as many texels.
const MAP_PICTURE_SIZE: u32 = sun::MAP_SIZE / 2;

fn main() -> ExitCode {
    arguments::run("city", run)
}

fn run(arguments: Arguments) -> Result<(), Box<dyn Error>> {
    let gpu = Gpu::new(&GpuRequest::default())?;
    picture::make_folder(&arguments.folder)?;
    let town = Town::new(&gpu.device)?;
    let casters: Vec<&dyn ShadowCaster> = town.casters.iter().map(|c| c as _).collect();
    let mut sun = Sun::new(&gpu)?;
    let count: usize = town.casters.iter().map(|caster| caster.len()).sum();
    println!("{count} buildings cast");

    let save = |name: &str, pixels: &[u8], size| {
        let path = arguments.folder.join(name);
        picture::save(&path, pixels, size).map(|()| println!("{}", path.display()))
    };
    let mut table = Table::default();
    for frame in 0..arguments.frames {
        let camera = flight::camera(frame, arguments.frames, SIZE);
        let pixels = sun.draw(&gpu, &town, &camera, &casters, Show::Scene)?;
        save(&format!("frame-{frame:03}.png"), &pixels, SIZE)?;
        print!("{}", table.add(sun.report(), sun.record_time()));
        if let Some(density) = sun.density(&gpu, &town, &camera)? {
            println!("    {density}");
        }
    }
    let count = table.frames();
    println!(
        "frame and record: {:.2?} of CPU time, the median of {count} frames",
        table.median_record_time()
    );

    let camera = flight::camera(0, arguments.frames, SIZE);
    let pixels = sun.draw(&gpu, &town, &camera, &casters, Show::Cascades)?;
    save("tint.png", &pixels, SIZE)?;
    for layer in 0..sun::CASCADES {
        let size = [MAP_PICTURE_SIZE; 2];
        let pixels = sun.draw_map(&gpu, layer, size)?;
        save(&format!("map-{layer}.png"), &pixels, size)?;
    }
    Ok(())
}
