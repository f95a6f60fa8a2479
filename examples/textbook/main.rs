//! Shows the shadow-mapping chapter of graphics tutorials step by step: each mistake, its remedy,
//! and a figure that proves it.
//!
//! `cargo run --example textbook [FOLDER]` draws one image per step into `target/textbook`, or the
//! folder named. The scene is that of
//! <https://learnopengl.com/Advanced-Lighting/Shadows/Shadow-Mapping>: a floor, three cubes and a
//! sun.
//!
//! ```text
//! steps.rs            what each step does, and what it shows
//! scene.rs            floor, cubes and sun
//! viewpoint.rs        the cameras
//! lookup.rs           how the shader samples visibility: by the library, or with the tutorial's mistake
//! painter.rs          the passes that draw the scene
//! rays.rs             the scene as rays see it, on the CPU
//! truth.rs            how far an image is from what is truly lit
//! scene.wgsl          the fragment stages
//! out_of_range.wgsl   the tutorial's mistake
//! ../support          meshes and Blinn-Phong
//! ```

mod lookup;
mod painter;
mod rays;
mod scene;
mod steps;
mod truth;
mod viewpoint;

use std::error::Error;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use clap::Parser;
use example_support::{arguments, map_picture, picture};
use glam::DVec3;
use shadow_support::gpu::{Gpu, GpuRequest};
use wgpu_shadows::{
    Casters, DirectionalShadow, ShadowCaster, ShadowFrameDescriptor, ShadowScene, debug::DebugImage,
};

use lookup::Lookup;
use scene::Scene;
use steps::{Show, Step};
use truth::Truth;

/// Draws the steps of the shadow-mapping tutorial, one image each.
#[derive(Parser)]
struct Arguments {
    /// Sets the folder for the images.
    #[arg(default_value = "target/textbook")]
    folder: PathBuf,
}

fn main() -> ExitCode {
    arguments::run("textbook", |arguments: Arguments| run(&arguments.folder))
}

fn run(folder: &Path) -> Result<(), Box<dyn Error>> {
    let gpu = Gpu::new(&GpuRequest::default())?;
    picture::make_folder(folder)?;
    let scene = Scene::new(&gpu.device);
    let mut figures = Vec::new();
    for step in steps::steps() {
        let path = folder.join(step.file);
        figures.push((step.file, draw(&gpu, &scene, &step, &path)?));
        println!("{}\n    {}", path.display(), step.sentence);
    }
    println!(
        "\nAgainst rays cast in double precision (levels: how many values the visibility takes):"
    );
    for (file, figure) in figures {
        println!("{file:32} {figure}");
    }
    Ok(())
}

/// Draws the image of `step` and returns how far it is from the truth.
fn draw(gpu: &Gpu, scene: &Scene, step: &Step, path: &Path) -> Result<String, Box<dyn Error>> {
    let camera = step.viewpoint.camera(painter::SIZE);
    let meshes = scene.casters(&gpu.device, step.cull)?;
    let casters: Vec<&dyn ShadowCaster> = meshes.iter().map(|mesh| mesh as _).collect();
    let mut sun = DirectionalShadow::new(&gpu.device, &step.shadow)?;
    let mut shadow_scene = ShadowScene::new();
    let frame = shadow_scene.frame(&ShadowFrameDescriptor {
        origin: DVec3::ZERO,
        coverage: step.region.coverage(&[camera.view]),
        casters: Casters::List(&casters),
        receivers: &[],
    })?;
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    sun.record(&mut encoder, &frame, &scene.sun())?;

    let lookup = match step.show {
        Show::Scene => Lookup::by_the_library(&gpu.device, &sun)?,
        Show::OutOfRangeMistake => Lookup::by_mistake(&gpu.device, &sun)?,
        Show::DepthMap => return draw_map(gpu, scene, &sun, encoder, path),
    };
    let painted = painter::paint(gpu, scene, &camera, &lookup, encoder)?;
    picture::save(path, &painted.picture, painter::SIZE)?;
    let truth = Truth::new(scene, &camera, painter::SIZE);
    Ok(truth.compare(&painted.visibility).to_string())
}

/// Draws the map of `sun`, one pixel per texel.
fn draw_map(
    gpu: &Gpu,
    scene: &Scene,
    sun: &DirectionalShadow,
    encoder: wgpu::CommandEncoder,
    path: &Path,
) -> Result<String, Box<dyn Error>> {
    let view = sun.maps().views().next().ok_or("nothing casts a shadow")?;
    let size = [view.map_size(); 2];
    let layer = DebugImage::Layer(view.layer());
    let pixels = map_picture::draw(gpu, encoder, sun.maps(), layer, size)?;
    picture::save(path, &pixels, size)?;
    let wrong = 100.0 * truth::compare_map(scene, view, &pixels);
    Ok(format!(
        "{wrong:6.2} % of the texels are more than one grey level off"
    ))
}
