//! Measures what static casters save: a frame against the share of casters that move.
//!
//! A view whose light, fit and casters did not change keeps its map. A view of which only some
//! casters move keeps the others in a static-caster cache, a texture of its own, where copying that
//! costs less than drawing them.

use std::time::Instant;

use glam::Vec3;
use shadow_support::measure::statistics::Spread;
use wgpu_shadows::{Casters, Coverage, Filter, ShadowCaster};

use super::counts::Counts;
use super::crowd::{self, Crowd};
use super::lamps::Lamps;
use super::processor;
use super::stage::{self, Stage, Sun};
use super::table::Growth;

const CASTERS: u32 = 2_000;
const LAMPS: u32 = 32;
/// Is the number of frames after which the library has found everything that does not change.
const SETTLING: u32 = 8;
/// Are percentages of the casters.
const SHARES: [u32; 6] = [0, 1, 3, 10, 30, 100];

/// Holds the shadows of some lights over a crowd.
trait Lit {
    /// Makes and records a frame, and returns its counts.
    fn record_frame(
        &mut self,
        encoder: &mut wgpu::CommandEncoder,
        casters: &[&dyn ShadowCaster],
    ) -> Counts;

    /// Records and submits frames until the library has found what is static.
    fn settle(&mut self, stage: &Stage<'_>, casters: &[&dyn ShadowCaster]) {
        for _ in 0..SETTLING {
            let mut encoder = stage.gpu.encoder();
            self.record_frame(&mut encoder, casters);
            stage.gpu.submit(encoder);
        }
    }
}

/// Measures a sun and a field of point lights, while more and more of the crowd around the middle
/// moves.
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
            "Mtexels",
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
                counts.texels as f64 * 1e-6,
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
        self.record(encoder, Casters::List(casters), crowd::half_side(CASTERS))
    }
}

/// Compares a frame in which one of many casters moves with the same frame drawn completely: what
/// the static-caster cache saves, and from how many casters on.
pub fn static_cache(stage: &Stage<'_>) {
    let mut table = Growth::new(
        "static-caster cache: one of so many casters moves; time of frame, record, submission and completion as a ratio to drawing all of them, by texels per side \
         (1 where nothing is cached)",
        &["casters", "512", "1024", "2048", "4096"],
    );
    for count in [100, 300, 1_000, 3_000, 10_000] {
        let crowd = crowd_with_one_in_motion(stage, count);
        let ratios =
            [512, 1024, 2048, 4096].map(|map_size| settled(stage, &crowd, map_size).0.median);
        table.add(f64::from(count), ratios);
    }
    table.print();
}

/// Is what a frame takes whose static casters come from the cache.
pub struct Cached {
    /// Is its time divided by that of a frame in which all casters are drawn.
    pub ratio: Spread,
    pub rule_takes_cache: bool,
}

/// Measures the cache where one of `count` casters moves, whether or not the library would take
/// it. Returns `None` where the device copies no depths.
pub fn cached_beside_drawn(stage: &Stage<'_>, count: u32, map_size: u32) -> Option<Cached> {
    let mut crowd = crowd_with_one_in_motion(stage, count);
    let (ratio, rule_takes_cache) = settled(stage, &crowd, map_size);
    if rule_takes_cache {
        return Some(Cached {
            ratio,
            rule_takes_cache,
        });
    }
    // Casters that are said to be many triangles are worth a cache.
    for caster in &mut crowd.boxes {
        caster.told_triangles = 1_000_000;
    }
    let (ratio, is_cached) = settled(stage, &crowd, map_size);
    is_cached.then_some(Cached {
        ratio,
        rule_takes_cache,
    })
}

fn crowd_with_one_in_motion(stage: &Stage<'_>, count: u32) -> Crowd {
    let mut crowd = Crowd::new(stage.gpu, count);
    crowd.set_in_motion(1, Vec3::ZERO);
    crowd
}

/// Returns the time of a frame after those in which the library finds what is static,
/// divided by that of a frame in which everything is drawn, and whether some casters were copied.
fn settled(stage: &Stage<'_>, crowd: &Crowd, map_size: u32) -> (Spread, bool) {
    let casters = crowd.list();
    let frame = stage::frame(&casters, Coverage::Bounds(crowd.bounds()));
    let sun = || stage.sun(map_size, 1, Filter::default());
    let (mut settled, mut anew) = (sun(), sun());
    for _ in 0..SETTLING {
        let mut encoder = stage.gpu.encoder();
        settled.record(&mut encoder, &frame);
        stage.gpu.submit(encoder);
    }
    // From the first command to the end, as for the faces of a lamp: copies and passes overlap.
    let seconds = |record: &mut dyn FnMut(&mut wgpu::CommandEncoder)| {
        let start = Instant::now();
        let mut encoder = stage.gpu.encoder();
        record(&mut encoder);
        stage.gpu.submit(encoder);
        start.elapsed().as_secs_f64()
    };
    let mut ratio = || {
        let before = seconds(&mut |encoder| anew.record_anew(encoder, &frame));
        let own = seconds(&mut |encoder| {
            settled.record(encoder, &frame);
        });
        own / before
    };
    // The first run warms up.
    ratio();
    let ratio = Spread::of((0..stage.repeats).map(|_| ratio()));
    let mut counts = Counts::default();
    counts.add(settled.shadow.maps().report());
    (ratio, counts.copied > 0)
}
