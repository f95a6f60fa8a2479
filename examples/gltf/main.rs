//! Renders a glTF 2.0 file with shadows, offscreen, to a PNG.
//!
//! ```text
//! cargo run --release --example gltf -- FILE.glb --out IMAGE.png
//! ```
//!
//! ```text
//! options.rs     the command line
//! load.rs        file to triangles, textures, lights and camera
//! images.rs      its textures, decoded
//! primitive.rs   one glTF primitive to a triangle list
//! scene.rs       a scene once it is loaded
//! device.rs      adapter, device, read-back
//! geometry.rs    vertex, index and instance buffers, textures, draw calls
//! casters.rs     the scene's ShadowCaster
//! lights.rs      the scene's shadows, and the WGSL that samples them
//! render.rs      pipelines and passes
//! measure.rs     times of the passes
//! report.rs      the report as JSON
//! ```

mod casters;
mod device;
mod geometry;
mod images;
mod lights;
mod load;
mod measure;
mod options;
mod primitive;
mod render;
mod report;
mod scene;

use std::error::Error;
use std::process::ExitCode;

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
    let scene = load::load(&options.file, options.size, 0)?;
    for note in &scene.notes {
        eprintln!("note: {note}");
    }
    let gpu = device::Gpu::new(options.adapter)?;
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
        device::save_png(path, &renderer.read_color(&gpu)?)?;
        println!("wrote {}", path.display());
    }
    if let Some(path) = &options.visibility {
        let picture = renderer.visibility(&gpu, &scene, &geometry, &lights)?;
        device::save_png(path, &picture)?;
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
