//! What standing still saves: a frame against the share of casters that move.
//!
//! A view whose light, fit and casters did not change keeps its map. One of whose casters some move keeps the others in a layer
//! of their own, its still part, where copying that costs less than drawing them.

use glam::Vec3;
use wgpu_shadows::{Coverage, Filter, ShadowCaster};

use super::counts::Counts;
use super::crowd::{self, Crowd};
use super::lamps::Lamps;
use super::processor;
use super::stage::{self, Stage, Sun};
use super::table::Growth;

const CASTERS: u32 = 2_000;
const LAMPS: u32 = 32;
/// Frames after which whatever does not change has been found out.
const SETTLING: u32 = 8;
/// Percent of the casters.
const SHARES: [u32; 6] = [0, 1, 3, 10, 30, 100];

/// Shadows of some lights over a crowd.
trait Lit {
    /// Makes and records a frame, and tells what it took.
    fn record_frame(
        &mut self,
        encoder: &mut wgpu::CommandEncoder,
        casters: &[&dyn ShadowCaster],
    ) -> Counts;

    /// Records and submits frames until what stands still is known to.
    fn settle(&mut self, stage: &Stage<'_>, casters: &[&dyn ShadowCaster]) {
        for _ in 0..SETTLING {
            let mut encoder = stage.gpu.encoder();
            self.record_frame(&mut encoder, casters);
            stage.gpu.submit(encoder);
        }
    }
}

/// A sun and a field of lamps, while more and more of the crowd around the middle moves.
pub fn moving_share(stage: &Stage<'_>) {
    measure(
        stage,
        "sun, four cascades of 1024 texels a side, 2000 casters: a frame against the share that moves, around the middle",
        || stage.sun(1024, 4, Filter::default()),
    );
    measure(
        stage,
        "32 point lights of 256 texels a side, 2000 casters: a frame against the share that moves, around the middle",
        || Lamps::new(stage.gpu, LAMPS),
    );
}

fn measure<L: Lit>(stage: &Stage<'_>, title: &str, make: impl Fn() -> L) {
    let all_move = crowd_with(stage, 100);
    let all_move = all_move.list();
    let mut all_lit = make();
    let mut table = Growth::new(
        format!("{title} (device time as a ratio to all of it)"),
        &[
            "moving %",
            "CPU µs",
            "allocs",
            "passes",
            "draws",
            "copied",
            "device ratio",
        ],
    );
    for share in SHARES {
        let crowd = crowd_with(stage, share);
        let casters = crowd.list();
        let mut lit = make();
        lit.settle(stage, &casters);
        let mut counts = Counts::default();
        let effort = processor::measure(
            stage.repeats,
            || stage.gpu.encoder(),
            |encoder| counts = lit.record_frame(encoder, &casters),
        );
        let ratio = stage.ratio(
            |encoder| {
                lit.record_frame(encoder, &casters);
            },
            |encoder| {
                all_lit.record_frame(encoder, &all_move);
            },
        );
        table.add(
            f64::from(share),
            [
                effort.microseconds,
                effort.allocations,
                f64::from(counts.passes),
                f64::from(counts.draws),
                f64::from(counts.copied),
                ratio.median,
            ],
        );
    }
    table.print();
}

fn crowd_with(stage: &Stage<'_>, moving_percent: u32) -> Crowd {
    let mut crowd = Crowd::new(stage.gpu, CASTERS);
    crowd.set_in_motion(CASTERS * moving_percent / 100, Vec3::ZERO);
    crowd
}

impl Lit for Sun {
    fn record_frame(
        &mut self,
        encoder: &mut wgpu::CommandEncoder,
        casters: &[&dyn ShadowCaster],
    ) -> Counts {
        let cameras = [stage::to_the_horizon(crowd::half_side(CASTERS))];
        let frame = stage::frame(casters, Coverage::Cameras(&cameras));
        let mut counts = Counts::default();
        counts.add(self.record(encoder, &frame));
        counts
    }
}

impl Lit for Lamps {
    fn record_frame(
        &mut self,
        encoder: &mut wgpu::CommandEncoder,
        casters: &[&dyn ShadowCaster],
    ) -> Counts {
        self.record(encoder, casters, crowd::half_side(CASTERS))
    }
}

/// A frame in which one of many casters moves, beside the same frame drawn anew: what the still part saves, and from how many
/// casters on.
pub fn still_part(stage: &Stage<'_>) {
    let mut table = Growth::new(
        "still part: one of so many casters moves; device time as a ratio to drawing all of them anew, by texels a side (1 where no \
         part is kept)",
        &["casters", "512", "1024", "2048", "4096"],
    );
    for count in [100, 300, 1_000, 3_000, 10_000] {
        let mut crowd = Crowd::new(stage.gpu, count);
        crowd.set_in_motion(1, Vec3::ZERO);
        let casters = crowd.list();
        let frame = stage::frame(&casters, Coverage::Bounds(crowd.bounds()));
        let ratios = [512, 1024, 2048, 4096].map(|map_size| {
            let sun = || stage.sun(map_size, 1, Filter::default());
            let (mut settled, mut anew) = (sun(), sun());
            let mut record = |encoder: &mut wgpu::CommandEncoder| {
                settled.record(encoder, &frame);
            };
            for _ in 0..SETTLING {
                let mut encoder = stage.gpu.encoder();
                record(&mut encoder);
                stage.gpu.submit(encoder);
            }
            let ratio = stage.ratio(record, |encoder| {
                anew.record_anew(encoder, &frame);
            });
            ratio.median
        });
        table.add(f64::from(count), ratios);
    }
    table.print();
}
