//! CPU time and allocations of `record`, and device time, against the number of casters and lights.

use glam::Vec3;
use wgpu_shadows::{Aabb, Coverage, Filter, OmniShadow};

use super::counts::Counts;
use super::crowd::{self, Crowd};
use super::lamps;
use super::processor;
use super::stage::{self, Stage};
use super::table::Growth;

/// CPU time and allocations of a frame against the number of casters, all of them in the map.
pub fn casters(stage: &Stage<'_>, most: u32) {
    let mut table = Growth::new(
        "sun, one cascade: `record` on the CPU against casters (all drawn; nothing changed; almost all culled), and the device \
         time of all drawn as a ratio to 100 casters",
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
    let mut few_shadow = stage.sun(1024, 1, Filter::default());
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
        let ratio = stage.ratio(
            |encoder| {
                let frame = stage::frame(&list, everything);
                stage::record_anew(stage.gpu, &mut shadow, encoder, &frame);
            },
            |encoder| stage::record_anew(stage.gpu, &mut few_shadow, encoder, &few_frame),
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

/// A frame against the number of point lights, over the same casters.
pub fn lights(stage: &Stage<'_>) {
    let crowd = Crowd::new(stage.gpu, 500);
    let list = crowd.list();
    let half = crowd::half_side(500);
    let mut table = Growth::new(
        "point lights of 256 texels a side over 500 casters: all `record` calls of a frame on the CPU, and the device time as a \
         ratio to one light",
        &[
            "lights",
            "drawn µs",
            "allocs",
            "draws",
            "passes",
            "device ratio",
        ],
    );
    let record = |lamps: &mut [OmniShadow], encoder: &mut wgpu::CommandEncoder| {
        lamps.iter_mut().for_each(OmniShadow::invalidate);
        lamps::record(stage.gpu, encoder, lamps, &list, half)
    };
    let mut one = lamps::make(stage.gpu, 1);
    for count in [1u32, 2, 4, 8, 16, 32, 64] {
        let mut all = lamps::make(stage.gpu, count);
        let mut counts = Counts::default();
        let effort = processor::measure(
            stage.repeats,
            || stage.gpu.encoder(),
            |encoder| counts = record(&mut all, encoder),
        );
        let ratio = stage.ratio(
            |encoder| {
                record(&mut all, encoder);
            },
            |encoder| {
                record(&mut one, encoder);
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
