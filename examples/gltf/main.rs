//! Renders a glTF 2.0 file with shadows, offscreen, to a PNG.
//!
//! ```text
//! cargo run --release --example gltf -- FILE.glb --out IMAGE.png
//! ```
//!
//! ```text
//! options.rs     the command line
//! geometry.rs    vertex, index and instance buffers, textures, draw calls
//! casters.rs     the scene's ShadowCaster
//! lights.rs      the scene's shadows, and the WGSL that samples them
//! render.rs      pipelines and passes
//! measure.rs     times of the passes
//! report.rs      the report as JSON
//! ../support     loads the file
//! ```

mod casters;
mod geometry;
mod lights;
mod maps;
mod measure;
mod options;
mod render;
mod report;

use std::error::Error;
use std::process::ExitCode;

use example_support::{gltf_file, picture};
use shadow_support::gpu::Gpu;

fn main() -> ExitCode {
    let options = match options::parse() {
        Ok(options) => options,
        Err(exit) => return exit,
    };
    match run(&options) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::FAILURE
        }
    }
}

fn run(options: &options::Options) -> Result<(), Box<dyn Error>> {
    let scene = gltf_file::load(&options.file, options.size, 0)?;
    for note in &scene.notes {
        eprintln!("note: {note}");
    }
    let gpu = Gpu::new(&options.gpu())?;
    let geometry = geometry::Geometry::upload(&gpu, &scene)?;
    let casters = casters::scene_casters(&gpu, &scene, &geometry)?;
    let mut lights = lights::SceneLights::new(&gpu, &scene, options)?;
    let renderer = render::Renderer::new(&gpu, &geometry, &lights, options.size)?;

    let times = measure::frames(
        &gpu,
        &scene,
        &geometry,
        &casters,
        &mut lights,
        &renderer,
        options,
    )?;
    if let Some(path) = &options.out {
        picture::save_image(path, &renderer.read_color(&gpu)?)?;
        println!("wrote {}", path.display());
    }
    if let Some(path) = &options.visibility {
        let visibility = renderer.visibility(&gpu, &scene, &geometry, &lights)?;
        picture::save_image(path, &visibility)?;
        println!("wrote {}", path.display());
    }
    let report = report::report(&gpu, &scene, &lights, &times);
    if let Some(path) = &options.report {
        std::fs::write(path, serde_json::to_string_pretty(&report)?)
            .map_err(|error| format!("cannot write {}: {error}", path.display()))?;
        println!("wrote {}", path.display());
    }
    Ok(())
}
