//! Measures device time of maps and lookups against cascades, map size and taps, and compares it
//! with the bare minimum.

use glam::{DMat4, DVec3, DVec4, Vec3};
use shadow_support::camera;
use shadow_support::gpu::Gpu;
use shadow_support::library::{LibraryOptions, LibraryTechnique, SceneCasters};
use shadow_support::measure::configuration::filter_name;
use shadow_support::measure::prober::Prober;
use shadow_support::measure::statistics::Spread;
use shadow_support::mesh::Mesh;
use shadow_support::scene::{Light, Scene};
use shadow_support::textbook::flat::DepthDrawer;
use shadow_support::textbook::meshes::{ViewUniform, WorldMeshes};
use wgpu_shadows::{Bias, CascadeLayout, Coverage, Filter};

use super::crowd::{self, Crowd};
use super::stage::{self, Stage, frame};
use super::table::Growth;

/// Measures a frame against the number of cascades, for a camera that sees to the end of the
/// ground.
pub fn cascades(stage: &Stage<'_>) {
    let crowd = Crowd::new(stage.gpu, 2_000);
    let list = crowd.list();
    let cameras = [stage::to_the_horizon(crowd::half_side(2_000))];
    let mut table = Growth::new(
        "sun, 1024 texels a side, 2000 casters: a frame against cascades (device time as a ratio to one cascade)",
        &[
            "cascades",
            "CPU µs",
            "allocs",
            "draws",
            "Mtexels",
            "device ratio",
        ],
    );
    let frame = frame(&list, Coverage::Cameras(&cameras));
    let mut single = stage.sun(1024, 1, Filter::default());
    for count in 1..=8 {
        let mut sun = stage.sun(1024, count, Filter::default());
        let effort = stage.record_effort(&mut sun, &frame, true);
        let ratio = stage.ratio(
            |encoder| sun.record_anew(encoder, &frame),
            |encoder| single.record_anew(encoder, &frame),
        );
        table.add(
            f64::from(count),
            [
                effort.microseconds,
                effort.allocations,
                f64::from(sun.shadow.maps().report().draws()),
                sun.shadow.maps().report().texels() as f64 * 1e-6,
                ratio.median,
            ],
        );
    }
    table.print();
}

/// Measures the depth pass against the size of the map.
pub fn map_sizes(stage: &Stage<'_>, largest: u32) {
    let crowd = Crowd::new(stage.gpu, 500);
    let list = crowd.list();
    let frame = frame(&list, Coverage::Bounds(crowd.bounds()));
    let mut table = Growth::new(
        "sun, 500 casters: the depth pass against the map's side (device time as a ratio to 512)",
        &["texels a side", "device ratio", "bytes"],
    );
    let mut smallest = stage.sun(512, 1, Filter::default());
    let sizes = (0..).map(|doublings| 512u32 << doublings);
    let limit = stage
        .gpu
        .device
        .limits()
        .max_texture_dimension_2d
        .min(largest);
    for size in sizes.take_while(|&size| size <= limit) {
        let mut sun = stage.sun(size, 1, Filter::default());
        let ratio = stage.ratio(
            |encoder| sun.record_anew(encoder, &frame),
            |encoder| smallest.record_anew(encoder, &frame),
        );
        let bytes_held = sun.shadow.maps().report().bytes_held;
        table.add(f64::from(size), [ratio.median, bytes_held as f64]);
    }
    table.print();
}

/// Measures lookups against texture instructions, for a point light, the one kind that all filters
/// suit.
pub fn taps(stage: &Stage<'_>) {
    let scene = lamp_scene(stage.gpu);
    let casters = SceneCasters::new(stage.gpu, &scene);
    let mut prober = Prober::new(stage.gpu);
    let half = crowd::half_side(500);
    let places: Vec<_> = (0..512 * 512)
        .map(|index| {
            let place = |index: i32| f64::from(half) * (f64::from(index) / 256.0 - 1.0);
            (
                DVec3::new(place(index % 512), 0.0, place(index / 512)),
                DVec3::Y,
            )
        })
        .collect();
    let questions = prober.questions(&places, DVec3::ZERO);
    let technique = |filter| {
        let options = LibraryOptions {
            filter,
            bias: Bias::Auto,
            map_size: 1024,
            fits_camera: false,
            layout: CascadeLayout::fixed(1),
        };
        LibraryTechnique::new(stage.gpu, &scene, &casters, options).expect("a valid light")
    };
    let mut table = Growth::new(
        "point light: 512x512 lookups in faces of 1024 texels a side, against texture instructions (time as a ratio to the \
         sampler's own 2x2 comparison)",
        &["instructions", "lookup ratio"],
    );
    let mut hardware = technique(Filter::Hardware);
    let mut lookups = |technique: &mut LibraryTechnique<'_>| {
        let times = prober.run(technique, &questions);
        times.expect("a valid frame").lookups
    };
    lookups(&mut hardware);
    println!();
    let mut filters = Filter::PLANAR.to_vec();
    filters.extend([
        Filter::DirectionStar { radius: 0.04 },
        Filter::Pcss { light_size: 0.1 },
        Filter::DirectionGrid { radius: 0.1 },
    ]);
    for filter in filters {
        let mut own = technique(filter);
        lookups(&mut own);
        let ratio = Spread::of((0..stage.repeats).map(|_| {
            let before = lookups(&mut hardware);
            lookups(&mut own) / before
        }));
        println!("{:>18} {:.2}", filter_name(filter), ratio.median);
        // PCSS ends early where nothing hides the light.
        if filter.compares_each_texel() && filter.light_size() == 0.0 {
            table.add(f64::from(filter.texture_instructions()), [ratio.median]);
        }
    }
    table.print();
}

/// Compares the library's depth pass with the same triangles in one draw without the library.
pub fn bare_minimum(stage: &Stage<'_>) {
    println!(
        "\nsun, 2048 texels a side: the depth pass beside the same triangles without the library, in a draw each and all in one draw"
    );
    for count in [100, 1_000, 10_000] {
        let ratios = beside_bare(stage, count, 2048);
        for (name, ratio) in ["a draw each", "one draw"].into_iter().zip(ratios) {
            println!(
                "{count:>18} casters: {:.3} times the bare pass of {name} on the device (middle half {:.3} to {:.3})",
                ratio.median, ratio.lower_quartile, ratio.upper_quartile
            );
        }
    }
}

/// Returns the time of the library's depth pass divided by that of the same triangles without the
/// library: in a draw each, as the textbook draws them, and all in one draw.
pub fn beside_bare(stage: &Stage<'_>, count: u32, map_size: u32) -> [Spread; 2] {
    let crowd = Crowd::new(stage.gpu, count);
    let list = crowd.list();
    let mut sun = stage.sun(map_size, 1, Filter::default());
    let frame = frame(&list, Coverage::Bounds(crowd.bounds()));
    stage.gpu.submit({
        let mut encoder = stage.gpu.encoder();
        sun.record_anew(&mut encoder, &frame);
        encoder
    });
    let view = sun.shadow.maps().views().next().expect("boxes cast");
    // The bare pass clears to 1 and keeps the least depth: the same image with its depth reversed.
    let turned = DMat4::from_cols(
        DVec4::X,
        DVec4::Y,
        DVec4::NEG_Z,
        DVec4::new(0.0, 0.0, 1.0, 1.0),
    );
    let clip_from_world = turned * view.clip_from_render().as_dmat4();
    let uniform = ViewUniform::new(clip_from_world, glam::Vec4::ZERO, glam::Vec4::ZERO);
    let drawer = DepthDrawer::new(stage.gpu, &uniform, map_size);
    let joined = std::slice::from_ref(&crowd.mesh);
    [
        WorldMeshes::in_shared_buffers(stage.gpu, &crowd.parts),
        WorldMeshes::of_meshes(stage.gpu, joined, DVec3::ZERO),
    ]
    .map(|meshes| {
        stage.ratio(
            |encoder| sun.record_anew(encoder, &frame),
            |encoder| drawer.draw(encoder, &meshes),
        )
    })
}

/// Returns boxes on ground under a point light, as a scene.
fn lamp_scene(gpu: &Gpu) -> Scene {
    let half = crowd::half_side(500);
    Scene {
        name: "crowd",
        meshes: vec![Mesh::floor(0.0, half).joined(Crowd::new(gpu, 500).mesh)],
        light: Light::Point {
            position_world: DVec3::new(0.0, 8.0, 0.0),
            range: 4.0 * half,
            radius_world: 0.0,
        },
        camera: camera::looking(Vec3::splat(half), Vec3::ZERO, 0.9),
        origin: DVec3::ZERO,
    }
}
