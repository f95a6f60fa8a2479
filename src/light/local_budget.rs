//! Selects the lights that are refreshed under a budget of views.

use crate::light::local::{Candidate, LocalLights, LocalPlacement};

/// Is the least importance that a light with an importance above 0 counts for, as a fraction of the
/// greatest in the frame.
const LEAST_SHARE_OF_IMPORTANCE: f64 = 1.0 / 4096.0;

impl LocalLights {
    /// Selects the lights to refresh within a budget of `max_views` rendered views. Lights that
    /// need a refresh are taken in descending order of urgency, which is the importance times (1 +
    /// the number of frames waited), so that no light of importance above 0 waits for ever. The
    /// first is always refreshed, however small the budget; each further one is refreshed if its
    /// views fit into the rest. Returns how many views those that are refreshed render.
    ///
    /// The products neither overflow nor underflow in f64: a finite f32 times 2³² is far below the
    /// largest f64. An importance above 0 counts for no less than [`LEAST_SHARE_OF_IMPORTANCE`] of
    /// the frame's greatest. Among `n` lights, one of weight `w` beside a greatest weight of `W`
    /// then waits at most `(n - 1) W / w + n` frames: once its product exceeds `(n - 1) W`, only
    /// lights that have waited for at least `n - 1` frames precede it, and each of the others can
    /// do so only once.
    pub(super) fn choose(
        &self,
        lights: &[LocalPlacement],
        max_views: u32,
        candidates: &mut [Candidate],
    ) -> u32 {
        let importances = lights.iter().map(|light| f64::from(light.importance));
        let least = importances.fold(0.0, f64::max) * LEAST_SHARE_OF_IMPORTANCE;
        let urgency = |index: usize| {
            let light = &lights[index];
            let weight = match f64::from(light.importance) {
                importance if importance > 0.0 => importance.max(least),
                _ => 0.0,
            };
            let waited = self.slots[light.slot as usize].waited;
            weight * (1.0 + f64::from(waited))
        };
        let mut order: Vec<usize> = (0..candidates.len())
            .filter(|&index| candidates[index].needed > 0)
            .collect();
        order.sort_by(|&a, &b| urgency(b).total_cmp(&urgency(a)));
        let mut spent = 0;
        for (rank, index) in order.into_iter().enumerate() {
            let candidate = &mut candidates[index];
            candidate.refreshed = rank == 0 || spent + candidate.needed <= max_views;
            if candidate.refreshed {
                spent += candidate.needed;
            }
        }
        spent
    }
}
