//! CPU time and allocations of `record` against the number of casters and lights.

use glam::{DVec3, Vec3};
use wgpu_shadows::{
    Aabb, Coverage, Filter, OmniFrame, OmniLight, OmniShadow, OmniShadowDescriptor,
};

use super::crowd::{self, Crowd};
use super::processor;
use super::stage::{self, Stage};
use super::table::Growth;

/// CPU time and allocations of a frame against the number of casters, all of them in the map.
pub fn casters(stage: &Stage<'_>, most: u32) {
    let mut table = Growth::new(
        "sun, one cascade: `record` on the CPU against casters (all drawn; nothing changed; almost all culled)",
        &[
            "casters",
            "drawn µs",
            "drawn allocs",
            "kept µs",
            "kept allocs",
            "culled µs",
            "culled allocs",
        ],
    );
    let sizes = (2..).map(|decade| 10u32.pow(decade));
    for count in sizes.take_while(|&count| count <= most) {
        let crowd = Crowd::new(stage.gpu, count);
        let list = crowd.list();
        let mut shadow = stage.sun(1024, 1, Filter::default());
        let everything = Coverage::Bounds(crowd.bounds());
        let drawn = stage.record_effort(&mut shadow, &stage::frame(&list, everything), true);
        let kept = stage.record_effort(&mut shadow, &stage::frame(&list, everything), false);
        let corner = Aabb::new(Vec3::ZERO, Vec3::splat(1.0));
        let culled = stage.record_effort(
            &mut shadow,
            &stage::frame(&list, Coverage::Bounds(corner)),
            true,
        );
        table.add(
            f64::from(count),
            [drawn, kept, culled]
                .iter()
                .flat_map(|effort| [effort.microseconds, effort.allocations])
                .collect::<Vec<_>>(),
        );
    }
    table.print();
}

/// CPU time of a frame against the number of point lights, over the same casters.
pub fn lights(stage: &Stage<'_>) {
    let crowd = Crowd::new(stage.gpu, 500);
    let list = crowd.list();
    let mut table = Growth::new(
        "point lights of 256 texels a side over 500 casters: all `record` calls of a frame on the CPU",
        &["lights", "drawn µs", "allocs", "draws", "passes"],
    );
    for count in [1u32, 2, 4, 8, 16, 32, 64] {
        let descriptor = OmniShadowDescriptor {
            map_size: 256,
            ..Default::default()
        };
        let mut lights: Vec<OmniShadow> = (0..count)
            .map(|_| OmniShadow::new(&stage.gpu.device, &descriptor).expect("a valid light"))
            .collect();
        let half = f64::from(crowd::half_side(500));
        let effort = processor::measure(
            stage.repeats,
            || stage.gpu.encoder(),
            |encoder| {
                for (index, light) in (0..).zip(&mut lights) {
                    light.invalidate();
                    let angle = 2.399_963 * f64::from(index);
                    let radius = half * (f64::from(index) / f64::from(count)).sqrt();
                    let position_world =
                        DVec3::new(radius * angle.cos(), 4.0, radius * angle.sin());
                    let frame = OmniFrame {
                        origin: DVec3::ZERO,
                        light: OmniLight {
                            position_world,
                            range: 10.0,
                        },
                        camera: None,
                        casters: &list,
                        receivers: &[],
                    };
                    light
                        .record(&stage.gpu.device, encoder, &frame)
                        .expect("a valid frame");
                }
            },
        );
        let draws: u32 = lights.iter().map(|light| light.report().draws()).sum();
        let passes: u32 = lights.iter().map(|light| light.report().passes).sum();
        table.add(
            f64::from(count),
            [
                effort.microseconds,
                effort.allocations,
                f64::from(draws),
                f64::from(passes),
            ],
        );
    }
    table.print();
}
