//! Measures CPU time and allocations of `frame` and `record` together, and device time, against the
//! number of casters and lights.

use glam::{DVec3, Vec3};
use shadow_support::camera;
use wgpu_shadows::{
    Aabb, Coverage, Filter, OmniLight, OmniShadow, OmniShadowDescriptor, ShadowScene,
};

use super::counts::Counts;
use super::crowd::{self, Crowd};
use super::lamps::Lamps;
use super::processor;
use super::stage::{self, Stage};
use super::table::Growth;

/// Measures CPU time and allocations of a frame against the number of casters, all of them in the
/// map.
pub fn casters(stage: &Stage<'_>, most: u32) {
    let mut table = Growth::new(
        "sun, one cascade: `frame` and `record` on the CPU against casters (all drawn; nothing changed; almost all culled), and \
         the device time of all drawn as a ratio to 100 casters",
        &[
            "casters",
            "drawn µs",
            "drawn allocs",
            "kept µs",
            "kept allocs",
            "culled µs",
            "culled allocs",
            "device ratio",
        ],
    );
    let few = Crowd::new(stage.gpu, 100);
    let few_list = few.list();
    let few_frame = stage::frame(&few_list, Coverage::Bounds(few.bounds()));
    let mut few_sun = stage.sun(1024, 1, Filter::default());
    let sizes = (2..).map(|decade| 10u32.pow(decade));
    for count in sizes.take_while(|&count| count <= most) {
        let crowd = Crowd::new(stage.gpu, count);
        let list = crowd.list();
        let mut sun = stage.sun(1024, 1, Filter::default());
        let everything = stage::frame(&list, Coverage::Bounds(crowd.bounds()));
        let corner = Aabb::new(Vec3::ZERO, Vec3::splat(1.0));
        let corner = stage::frame(&list, Coverage::Bounds(corner));
        let drawn = stage.record_effort(&mut sun, &everything, true);
        let kept = stage.record_effort(&mut sun, &everything, false);
        let culled = stage.record_effort(&mut sun, &corner, true);
        let ratio = stage.ratio(
            |encoder| sun.record_anew(encoder, &everything),
            |encoder| few_sun.record_anew(encoder, &few_frame),
        );
        let mut figures: Vec<f64> = [drawn, kept, culled]
            .iter()
            .flat_map(|effort| [effort.microseconds, effort.allocations])
            .collect();
        figures.push(ratio.median);
        table.add(f64::from(count), figures);
    }
    table.print();
}

/// Measures fit and cull of four cascades before a camera that sees a corner of the crowd, and of a
/// point light in its middle.
pub fn culling(stage: &Stage<'_>, most: u32) {
    let mut table = Growth::new(
        "`frame` and `record` on the CPU against casters: four cascades out to 60 m, drawn and kept, and a lamp of 20 m, kept",
        &[
            "casters",
            "drawn µs",
            "casters in views",
            "kept µs",
            "kept allocs",
            "lamp kept µs",
            "lamp allocs",
        ],
    );
    let sizes = (2..).map(|decade| 10u32.pow(decade));
    for count in sizes.take_while(|&count| count <= most) {
        let crowd = Crowd::new(stage.gpu, count);
        let list = crowd.list();
        let mut sun = stage.sun(256, 4, Filter::default());
        let camera = camera::looking(Vec3::new(0.0, 2.0, 0.0), Vec3::new(9.0, 1.0, 5.0), 0.9);
        let cameras = [camera.with_max_distance(60.0)];
        let frame = stage::frame(&list, Coverage::Cameras(&cameras));
        let drawn = stage.record_effort(&mut sun, &frame, true);
        let kept = stage.record_effort(&mut sun, &frame, false);
        let in_views = sun
            .shadow
            .maps()
            .report()
            .views
            .iter()
            .map(|view| view.casters);
        let in_views: u32 = in_views.sum();
        let descriptor = OmniShadowDescriptor {
            map_size: 64,
            ..Default::default()
        };
        let mut lamp = OmniShadow::new(&stage.gpu.device, &descriptor).expect("valid shadows");
        let light = OmniLight {
            position_world: DVec3::new(0.0, 6.0, 0.0),
            range: 20.0,
        };
        let mut scene = ShadowScene::new();
        let everything = stage::frame(&list, Coverage::Everything);
        let mut record_lamp = |encoder: &mut wgpu::CommandEncoder| {
            let frame = scene.frame(&everything).expect("a valid frame");
            let report = lamp.record(encoder, &frame, &light);
            report.expect("a valid light").passes
        };
        let mut first = stage.gpu.encoder();
        record_lamp(&mut first);
        stage.gpu.submit(first);
        let lamp_kept = processor::measure(stage.repeats, || stage.gpu.encoder(), record_lamp);
        table.add(
            f64::from(count),
            [
                drawn.microseconds,
                f64::from(in_views),
                kept.microseconds,
                kept.allocations,
                lamp_kept.microseconds,
                lamp_kept.allocations,
            ],
        );
    }
    table.print();
}

/// Measures a frame against the number of point lights, over the same casters.
pub fn lights(stage: &Stage<'_>) {
    let crowd = Crowd::new(stage.gpu, 500);
    let list = crowd.list();
    let half = crowd::half_side(500);
    let mut table = Growth::new(
        "point lights of 256 texels a side over 500 casters: one `frame` for all and the `record` of each on the CPU, and the \
         device time as a ratio to one light",
        &[
            "lights",
            "drawn µs",
            "allocs",
            "draws",
            "passes",
            "device ratio",
        ],
    );
    let mut one = Lamps::new(stage.gpu, 1);
    for count in [1u32, 2, 4, 8, 16, 32, 64] {
        let mut all = Lamps::new(stage.gpu, count);
        let mut counts = Counts::default();
        let effort = processor::measure(
            stage.repeats,
            || stage.gpu.encoder(),
            |encoder| counts = all.record_anew(encoder, &list, half),
        );
        let ratio = stage.ratio(
            |encoder| {
                all.record_anew(encoder, &list, half);
            },
            |encoder| {
                one.record_anew(encoder, &list, half);
            },
        );
        table.add(
            f64::from(count),
            [
                effort.microseconds,
                effort.allocations,
                f64::from(counts.draws),
                f64::from(counts.passes),
                ratio.median,
            ],
        );
    }
    table.print();
}
