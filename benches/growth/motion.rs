//! What standing still saves: a frame against the share of casters that move.
//!
//! A view whose light, fit and casters did not change keeps its map, so what a frame takes depends on how many views see
//! something move, not on how much moves.

use glam::Vec3;
use wgpu_shadows::{Coverage, DirectionalShadow, Filter, OmniShadow, ShadowCaster};

use super::crowd::{self, Crowd};
use super::lamps;
use super::processor;
use super::stage::{self, Stage};
use super::table::Growth;

const CASTERS: u32 = 2_000;
const LAMPS: u32 = 32;
/// Percent of the casters.
const SHARES: [u32; 6] = [0, 1, 3, 10, 30, 100];

/// Shadows of some lights over a crowd.
trait Lit {
    /// Records a frame, and tells the passes and draws that it took.
    fn record(
        &mut self,
        stage: &Stage<'_>,
        encoder: &mut wgpu::CommandEncoder,
        casters: &[&dyn ShadowCaster],
    ) -> [u32; 2];
}

struct Sun(DirectionalShadow);
struct Lamps(Vec<OmniShadow>);

/// A sun and a field of lamps, while more and more of the crowd around the middle moves.
pub fn moving_share(stage: &Stage<'_>) {
    measure(
        stage,
        "sun, four cascades of 1024 texels a side, 2000 casters: a frame against the share that moves, around the middle",
        || Sun(stage.sun(1024, 4, Filter::default())),
    );
    measure(
        stage,
        "32 point lights of 256 texels a side, 2000 casters: a frame against the share that moves, around the middle",
        || Lamps(lamps::make(stage.gpu, LAMPS)),
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
            "device ratio",
        ],
    );
    for share in SHARES {
        let crowd = crowd_with(stage, share);
        let casters = crowd.list();
        let mut lit = make();
        // The first frame draws everything.
        let mut first = stage.gpu.encoder();
        lit.record(stage, &mut first, &casters);
        stage.gpu.submit(first);
        let mut counts = [0; 2];
        let effort = processor::measure(
            stage.repeats,
            || stage.gpu.encoder(),
            |encoder| counts = lit.record(stage, encoder, &casters),
        );
        let ratio = stage.ratio(
            |encoder| {
                lit.record(stage, encoder, &casters);
            },
            |encoder| {
                all_lit.record(stage, encoder, &all_move);
            },
        );
        let [passes, draws] = counts.map(f64::from);
        table.add(
            f64::from(share),
            [
                effort.microseconds,
                effort.allocations,
                passes,
                draws,
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
    fn record(
        &mut self,
        stage: &Stage<'_>,
        encoder: &mut wgpu::CommandEncoder,
        casters: &[&dyn ShadowCaster],
    ) -> [u32; 2] {
        let camera = stage::to_the_horizon(crowd::half_side(CASTERS));
        let frame = stage::frame(casters, Coverage::Camera(camera));
        let report = self.0.record(&stage.gpu.device, encoder, &frame);
        let report = report.expect("a valid frame");
        [report.passes, report.draws()]
    }
}

impl Lit for Lamps {
    fn record(
        &mut self,
        stage: &Stage<'_>,
        encoder: &mut wgpu::CommandEncoder,
        casters: &[&dyn ShadowCaster],
    ) -> [u32; 2] {
        let half = crowd::half_side(CASTERS);
        lamps::record(stage.gpu, encoder, &mut self.0, casters, half)
    }
}
