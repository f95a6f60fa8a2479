//! Measures in a minute what a GPU's owner can add to `doc/measured_on.md`: one row.

use glam::{DVec3, Vec3};
use shadow_support::camera;
use shadow_support::library::{LibraryOptions, LibraryTechnique, SceneCasters};
use shadow_support::measure::prober::Prober;
use shadow_support::measure::statistics::Spread;
use shadow_support::mesh::Mesh;
use shadow_support::scene::{Light, Scene};
use shadow_support::technique::Technique;
use shadow_support::textbook::flat::FlatTechnique;
use shadow_support::textbook::meshes::WorldMeshes;
use wgpu_shadows::{Bias, CascadeLayout, Filter};

use super::crowd::{self, Crowd};
use super::stage::Stage;
use super::{device, faces, motion};

/// Is the number of casters of the passes.
const CASTERS: u32 = 1_000;
const MAP_SIZE: u32 = 2048;
/// Is the number of lookups per side of their square: about as many as an image has pixels.
const LOOKUPS: i32 = 1024;

/// Prints the row, with the columns of the file's table.
pub fn row(stage: &Stage<'_>) {
    let adapter = &stage.gpu.adapter;
    let passes = device::beside_bare(stage, CASTERS, MAP_SIZE);
    let lookups = lookups(stage);
    let faces = [
        faces::compare(stage, 50, 3, 2),
        faces::compare(stage, 50, 3, 9),
    ];
    let caches = [
        motion::cached_beside_drawn(stage, 3_000, 1024),
        motion::cached_beside_drawn(stage, 100, 2048),
    ];
    let choice = |found: Option<(Spread, bool)>| {
        let words = found.map(|(ratio, takes)| {
            let word = if takes { "taken" } else { "not taken" };
            format!("{:.2} {word}", ratio.median)
        });
        words.unwrap_or_else(|| "-".to_owned())
    };
    let faces = faces.map(|faces| choice(faces.map(|it| (it.ratio, it.rule_takes_one_pass))));
    let caches = caches.map(|cache| choice(cache.map(|it| (it.ratio, it.rule_takes_cache))));
    println!(
        "| {} | {} | {} | {:.2}, {:.2} | {} | {} | {} |",
        adapter.name,
        format!("{} {}", adapter.driver, adapter.driver_info).trim(),
        adapter.backend,
        passes[0].median,
        passes[1].median,
        lookups.map_or_else(|| "-".to_owned(), |ratio| format!("{:.2}", ratio.median)),
        faces.join(", "),
        caches.join(", "),
    );
}

/// Returns the time of the default's lookups divided by the textbook's; `None` over OpenGL, since
/// naga writes no GLSL for those.
fn lookups(stage: &Stage<'_>) -> Option<Spread> {
    let gpu = stage.gpu;
    if gpu.adapter.backend == wgpu::Backend::Gl {
        return None;
    }
    let half = crowd::half_side(CASTERS);
    let scene = Scene {
        name: "crowd",
        meshes: vec![Mesh::floor(0.0, half).joined(Crowd::new(gpu, CASTERS).mesh)],
        light: Light::Sun {
            direction: Vec3::new(-0.5, -1.0, -0.3),
            angular_diameter_radians: 0.0,
        },
        camera: camera::looking(Vec3::splat(half), Vec3::ZERO, 0.9),
        origin: DVec3::ZERO,
    };
    let casters = SceneCasters::new(gpu, &scene);
    let options = LibraryOptions {
        filter: Filter::default(),
        bias: Bias::Auto,
        map_size: MAP_SIZE,
        fits_camera: false,
        layout: CascadeLayout::fixed(1),
    };
    let mut own = LibraryTechnique::new(gpu, &scene, &casters, options).expect("a valid light");
    let meshes = WorldMeshes::new(gpu, &scene);
    let mut textbook = FlatTechnique::new(gpu, &scene, &meshes, MAP_SIZE);

    let mut prober = Prober::new(gpu);
    let places: Vec<_> = (0..LOOKUPS * LOOKUPS)
        .map(|index| {
            let place =
                |index: i32| f64::from(half) * (f64::from(2 * index) / f64::from(LOOKUPS) - 1.0);
            let place = DVec3::new(place(index % LOOKUPS), 0.0, place(index / LOOKUPS));
            (place, DVec3::Y)
        })
        .collect();
    let questions = prober.questions(&places, DVec3::ZERO);
    let mut seconds = |technique: &mut dyn Technique| {
        let times = prober.run(technique, &questions);
        times.expect("a valid frame").lookups
    };
    let mut ratio = || {
        let before = seconds(&mut textbook);
        seconds(&mut own) / before
    };
    // The first run warms up.
    ratio();
    Some(Spread::of((0..stage.repeats).map(|_| ratio())))
}
