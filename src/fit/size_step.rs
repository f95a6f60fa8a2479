//! Quantizes sizes to geometric steps, so that a fit changes its scale rarely, and then clearly.

/// Lists the size steps from one power of two to the next: 2^(0/4), 2^(1/4), 2^(2/4), 2^(3/4), 2. A
/// step is at most 1.19 times the size that it was requested for, 1.09 times on average; finer
/// steps are tighter and change more often. They are a table, so that a scene scaled by a power of
/// two has the same steps to the bit.
const STEPS: [f64; 5] = [
    1.0,
    1.189_207_115_002_721,
    std::f64::consts::SQRT_2,
    1.681_792_830_507_429,
    2.0,
];

/// Is how much room a smaller step must have to spare before a held step is left for it, so that a
/// size that varies around a step does not change it every frame.
const SHRINK_SLACK: f64 = 1.05;

/// Returns the smallest size step that is at least `size` (positive and finite).
pub(crate) fn size_step_up(size: f64) -> f64 {
    // log2 may round to the next integer at a power of two; the octave below or above then serves
    // as well.
    let octave = size.log2().floor().exp2();
    STEPS
        .iter()
        .map(|step| step * octave)
        .find(|step| *step >= size)
        .unwrap_or(4.0 * octave)
}

/// Is the number of frames after which a size is reduced if it was larger than needed in all of
/// them, by at least one size step. This is two seconds at sixty frames per second.
const SHRINK_FRAMES: u32 = 120;

/// Is the factor by which a size exceeds the need if it grows a second time within
/// [`SHRINK_FRAMES`]: an octave, so that an object that moves away steadily changes the size once
/// per octave.
const GROWTH_AHEAD: f64 = 2.0;

/// Is the fraction of an earlier need below which the present need counts as that of another scene,
/// after a cut of the camera for example. The size is then reduced in half the time.
const SUDDEN_DROP: f64 = 0.25;

/// Is the fraction of a size below which a need makes the size useless, so that it is reduced at
/// once: after a frame with far too large bounds, for example.
const USELESS: f64 = 0.125;

/// Holds a quantized size from frame to frame. It grows at once where more is needed and shrinks
/// late, so that a moving caster or a turning camera does not change the texels of static shadows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct HeldSize {
    step: f64,
    /// Is the largest size needed in the last `frames` frames.
    peak: f64,
    /// Counts the frames up to [`SHRINK_FRAMES`], and starts again at 0.
    frames: u32,
    /// Counts the frames since the step grew.
    since_growth: u32,
}

impl HeldSize {
    /// Returns a held size without history, at the smallest step that is at least `size` (positive
    /// and finite).
    pub(super) fn new(size: f64) -> Self {
        Self {
            step: size_step_up(size),
            peak: size,
            frames: 0,
            since_growth: u32::MAX,
        }
    }

    /// Returns the size step.
    pub(super) fn step(&self) -> f64 {
        self.step
    }

    /// Returns the held size of the next frame, which needs `size`.
    pub(super) fn next(self, size: f64) -> Self {
        if size > self.step {
            let grew_lately = self.since_growth < SHRINK_FRAMES;
            return Self {
                step: size_step_up(if grew_lately {
                    size * GROWTH_AHEAD
                } else {
                    size
                }),
                since_growth: 0,
                ..Self::new(size)
            };
        }
        if size < self.step * USELESS {
            return Self::new(size);
        }
        // A need of long ago, or one that is far greater than the present, is discarded.
        let begins_anew = self.frames >= SHRINK_FRAMES || size < self.peak * SUDDEN_DROP;
        let next = Self {
            peak: if begins_anew {
                size
            } else {
                self.peak.max(size)
            },
            frames: if begins_anew { 0 } else { self.frames + 1 },
            since_growth: self.since_growth.saturating_add(1),
            ..self
        };
        let smaller = size_step_up(next.peak * SHRINK_SLACK);
        let gain = next.step / smaller;
        // A size that exceeds the need after repeated growth is kept for some time.
        let least_gain = if next.since_growth < 4 * SHRINK_FRAMES {
            GROWTH_AHEAD
        } else {
            1.0
        };
        let wait = if gain >= 1.0 / SUDDEN_DROP {
            SHRINK_FRAMES / 2
        } else {
            SHRINK_FRAMES
        };
        if gain > least_gain && next.frames >= wait {
            return Self {
                step: smaller,
                frames: 0,
                peak: size,
                ..next
            };
        }
        next
    }

    /// Returns the held size of a frame that needs `size`. `held` is that of the frame before, if
    /// there was one.
    pub(super) fn following(held: Option<Self>, size: f64) -> Self {
        held.map_or_else(|| Self::new(size), |held| held.next(size))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_size_step_is_at_least_its_size_and_at_most_one_step_larger() {
        let mut size = 1e-9;
        while size < 1e9 {
            let step = size_step_up(size);
            assert!(step >= size && step <= size * 2.0_f64.powf(0.25) * (1.0 + 1e-12));
            assert_eq!(size_step_up(step), step, "a step is its own step");
            size *= 1.0137;
        }
    }

    /// Returns how many times the step changes over the sizes, and the final step.
    fn changes(sizes: impl IntoIterator<Item = f64>) -> (usize, f64) {
        let mut sizes = sizes.into_iter();
        let mut held = HeldSize::new(sizes.next().expect("a size"));
        let mut changes = 0;
        for size in sizes {
            let next = held.next(size);
            assert!(next.step() >= size);
            changes += usize::from(next.step() != held.step());
            held = next;
        }
        (changes, held.step())
    }

    #[test]
    fn sizes_that_vary_change_their_step_once() {
        let trembling = (0..1000).map(|frame| 1.0 + 0.02 * f64::from(frame * 7).sin());
        assert!(changes(trembling).0 <= 1);
        let swinging = (0..1000).map(|frame| 2.0 + f64::from(frame).mul_add(0.07, 0.3).sin());
        assert!(
            changes(swinging).0 <= 3,
            "{:?}",
            changes((0..1000).map(|frame| 2.0 + f64::from(frame).mul_add(0.07, 0.3).sin()))
        );
    }

    /// Checks that growth by a factor of 16 over 1000 frames changes the step at most once per
    /// octave, and that the step may shrink and grow again in between where growth is slow.
    #[test]
    fn steady_growth_changes_the_step_rarely() {
        let growing = (0..1000).map(|frame| 16.0_f64.powf(f64::from(frame) / 1000.0));
        let (count, last) = changes(growing);
        assert!(count <= 8 && last < 16.0 * 2.4, "{count} {last}");
    }

    #[test]
    fn a_smaller_need_is_met_late_and_a_much_smaller_one_soon() {
        let drop = |to: f64| {
            let mut held = HeldSize::new(1.0);
            (1..1000)
                .find(|_| {
                    held = held.next(to);
                    held.step() < 1.0
                })
                .expect("it shrinks")
        };
        // In the first frames the larger need still counts.
        assert!((120..=242).contains(&drop(0.75)), "{}", drop(0.75));
        assert_eq!(drop(0.2), 61);
        assert_eq!(drop(0.1), 1);
    }
}
