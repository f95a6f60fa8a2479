//! Chooses the sizes of the squares of a layer that views share, by what each would gain.
//!
//! The squared error of a view is its weight times the size of its texels. If the weights were
//! right, the error would be least, at a given number of texels in all, where the texels of each
//! view are in proportion to (weight × size)^(2/3), as for the cascades of a directional light. But
//! weights that follow from bounds differ less than the true ones: with an exponent of 1 the error
//! is lower by 5 percent in a hall of 32 lamps and in a street of 200 (`cargo bench --bench
//! speed_vs_error -- --only-lamps`).
//!
//! Sides are powers of two fractions of the layer's, which costs 3 percent of the error where needs
//! are spread evenly: r, the texels over the ideal, is between 1/2 and 2, and the mean of r times
//! the square of that of r^(-1/2) is 1.13, of which the error is the fourth root.

/// Is the number of levels, beyond the half of one that rounding needs, by which the ideal size may
/// differ from the present one before the size is changed.
const SLACK_LEVELS: f64 = 0.25;

/// Is the factor by which the predicted error of other sizes must be lower for a change. The error
/// goes with the number of texels to the power of -1/4, so that the change is worth 1.4 times the
/// texels. It is nearer to 1 than for the cascades of a directional light, all of which a change
/// draws again, because here only the views that change are.
const BETTER: f64 = 0.92;

/// Is the number of predictions in a row for which other sizes must be better: 48 frames.
const TIMES_BETTER: u32 = 3;

/// Is the factor by which the predicted error of other sizes must be lower for a change at once: it
/// is then worth 2.4 times the texels, as after a cut of the camera.
const MUCH_BETTER: f64 = 0.8;

/// States what a view wants of the layer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Wanted {
    /// Is the squared error, up to a factor, that a unit of texel size adds.
    pub weight: f64,
    /// Is the side of what the view covers, the mean along x and y, in the same unit.
    pub size: f64,
}

impl Wanted {
    /// Returns the number that the ideal number of texels is in proportion to.
    fn share(&self) -> f64 {
        self.weight * self.size
    }

    /// Returns the squared error, up to a factor, of a square of `level`.
    fn squared_error(&self, level: u32) -> f64 {
        self.weight * self.size * f64::from(level).exp2()
    }
}

/// Holds the sizes of squares from prediction to prediction: how often the side of the layer is
/// halved for each view; `None` for views that need none.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct SquareSizes {
    levels: Vec<Option<u32>>,
    /// Counts the predictions in a row for which other sizes were better.
    better: u32,
}

impl SquareSizes {
    /// Returns the level of a view.
    pub(crate) fn level(&self, view: usize) -> Option<u32> {
        self.levels.get(view).copied().flatten()
    }

    /// Discards the level of a view.
    pub(crate) fn release(&mut self, view: usize) {
        if let Some(level) = self.levels.get_mut(view) {
            *level = None;
        }
    }

    /// Chooses sizes for all views that want some. The sizes of before are kept unless others are
    /// clearly better, or no longer fit. `finest` is the finest level; as many squares of it as
    /// there are views fit into the layer.
    pub(crate) fn choose(&mut self, wanted: &[Option<Wanted>], finest: u32) {
        self.levels.resize(wanted.len(), None);
        let views = wanted.iter().zip(&self.levels).map(|(wanted, held)| {
            let share = wanted.as_ref().map(Wanted::share)?;
            Some(View { share, held: *held })
        });
        let best = levels(&views.collect::<Vec<_>>(), finest);
        let squared_error = |levels: &[Option<u32>]| {
            let both = wanted.iter().zip(levels);
            let each =
                both.filter_map(|(wanted, level)| Some(wanted.as_ref()?.squared_error((*level)?)));
            each.sum::<f64>()
        };
        // Views that had no size get theirs at any rate.
        let kept = self.levels.iter().zip(&best);
        let kept: Vec<Option<u32>> = kept
            .map(|(held, best)| best.map(|best| held.unwrap_or(best)))
            .collect();
        if taken(&kept, finest) <= 1 << (2 * finest) {
            let ratio = (squared_error(&best) / squared_error(&kept)).sqrt();
            self.better = if ratio < BETTER { self.better + 1 } else { 0 };
            if !(ratio < MUCH_BETTER || self.better >= TIMES_BETTER) {
                self.levels = kept;
                return;
            }
        }
        self.better = 0;
        self.levels = best;
    }

    /// Gives all views that want a square squares of one size. They grow when there has been room
    /// for it as often as other sizes must be better.
    pub(crate) fn share_equally(&mut self, wanted: &[Option<Wanted>], finest: u32) {
        let count = wanted.iter().flatten().count() as u64;
        let fits = |level: &u32| count <= 1 << (2 * level);
        let coarsest = (0..finest).find(fits).unwrap_or(finest);
        let held = self.levels.iter().flatten().max();
        let held = held.copied().filter(|held| *held > coarsest);
        self.better = if held.is_some() { self.better + 1 } else { 0 };
        let level = match held {
            Some(held) if self.better < TIMES_BETTER => held.min(finest),
            _ => coarsest,
        };
        self.levels.clear();
        let levels = wanted.iter().map(|wanted| wanted.map(|_| level));
        self.levels.extend(levels);
    }
}

/// Is a view that wants a square.
#[derive(Clone, Copy, Debug)]
struct View {
    share: f64,
    held: Option<u32>,
}

impl View {
    /// Returns the ideal level where a share of one has `scale` layers.
    fn ideal(&self, scale: f64) -> f64 {
        -0.5 * (scale * self.share).log2()
    }

    /// Returns the level at that scale, which does not grow with the scale.
    fn level(&self, scale: f64, finest: u32) -> u32 {
        let ideal = self.ideal(scale);
        match self.held {
            Some(held) if self.keeps(held, ideal) => held.min(finest),
            _ => ideal.round().clamp(0.0, f64::from(finest)) as u32,
        }
    }

    fn keeps(&self, held: u32, ideal: f64) -> bool {
        (ideal - f64::from(held)).abs() <= 0.5 + SLACK_LEVELS
    }
}

/// Returns the number of squares of the finest level that squares of these levels take.
fn taken(levels: &[Option<u32>], finest: u32) -> u64 {
    let levels = levels.iter().flatten();
    levels.map(|level| 1u64 << (2 * (finest - level))).sum()
}

/// Returns the largest sizes that fit into a layer, in proportion to the shares of the views.
fn levels(views: &[Option<View>], finest: u32) -> Vec<Option<u32>> {
    let at = |scale: f64| -> Vec<Option<u32>> {
        let level = |view: &Option<View>| view.map(|view| view.level(scale, finest));
        views.iter().map(level).collect()
    };
    let room = 1u64 << (2 * finest);
    let shares = views.iter().flatten().map(|view| view.share);
    let (least, most) = shares.fold((f64::INFINITY, 0.0_f64), |(least, most), share| {
        (least.min(share), most.max(share))
    });
    if most <= 0.0 {
        return at(1.0);
    }
    // At the low end all views have the finest level, at the high end all have the whole layer.
    let mut low = -2.0 * f64::from(finest) - 4.0 - most.log2();
    let mut high = 4.0 - least.log2();
    let mut best = at(low.exp2());
    for _ in 0..40 {
        let middle = 0.5 * (low + high);
        let tried = at(middle.exp2());
        if taken(&tried, finest) <= room {
            (low, best) = (middle, tried);
        } else {
            high = middle;
        }
    }
    // What is left goes to the views whose ideal is the nearest to a larger size.
    let mut left = room - taken(&best, finest);
    let scale = low.exp2();
    let mut order: Vec<(f64, usize)> = views
        .iter()
        .enumerate()
        .filter_map(|(index, view)| {
            let (view, level) = (view.as_ref()?, best[index]?);
            let larger = level.checked_sub(1)?;
            let short = f64::from(level) - view.ideal(scale);
            view.keeps(larger, view.ideal(scale))
                .then_some((short, index))
        })
        .collect();
    order.sort_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
    for (_, index) in order {
        if let Some(level) = &mut best[index] {
            let more = 3u64 << (2 * (finest - *level));
            if more <= left {
                left -= more;
                *level -= 1;
            }
        }
    }
    best
}

#[cfg(test)]
mod tests {
    use super::*;

    fn wanted(weights: &[f64]) -> Vec<Option<Wanted>> {
        let each = weights.iter().map(|weight| {
            let some = Wanted {
                weight: *weight,
                size: 2.0,
            };
            (*weight > 0.0).then_some(some)
        });
        each.collect()
    }

    fn area(sizes: &SquareSizes, count: usize) -> f64 {
        let levels = (0..count).filter_map(|view| sizes.level(view));
        levels.map(|level| 0.25_f64.powi(level as i32)).sum()
    }

    /// All squares together fit into the layer and fill most of it, those that are worth more are
    /// no smaller, and a view that wants none has none.
    #[test]
    fn sizes_fit_and_follow_the_weights() {
        let mut weights: Vec<f64> = (0..30).map(|view| 1.3_f64.powi(view)).collect();
        weights[7] = 0.0;
        let mut sizes = SquareSizes::default();
        sizes.choose(&wanted(&weights), 6);
        let share = area(&sizes, 30);
        assert!(share > 0.8 && share <= 1.0, "{share}");
        assert_eq!(sizes.level(7), None);
        let levels: Vec<u32> = (0..30).filter_map(|view| sizes.level(view)).collect();
        assert!(levels.is_sorted_by(|a, b| a >= b), "{levels:?}");
    }

    /// Weights that vary by a fifth change no size. One that grows a hundredfold gets more at once.
    #[test]
    fn sizes_rarely_change() {
        let mut sizes = SquareSizes::default();
        let weight = |view: usize, step: usize| {
            1.5_f64.powi(view as i32 % 9) * (1.0 + 0.2 * ((view * 7 + step * 3) as f64).sin())
        };
        let at = |step| (0..40).map(|view| weight(view, step)).collect::<Vec<_>>();
        sizes.choose(&wanted(&at(0)), 7);
        let first = sizes.levels.clone();
        for step in 1..200 {
            sizes.choose(&wanted(&at(step)), 7);
            assert_eq!(sizes.levels, first, "in {step}");
        }
        let mut changed = at(200);
        changed[0] *= 1000.0;
        sizes.choose(&wanted(&changed), 7);
        assert!(sizes.level(0) < first[0]);
        assert!(area(&sizes, 40) <= 1.0);
    }

    /// Without a camera all have the same size, the largest that fits, which grows late.
    #[test]
    fn equal_sizes() {
        let mut sizes = SquareSizes::default();
        sizes.share_equally(&wanted(&[1.0; 17]), 5);
        assert!((0..17).all(|view| sizes.level(view) == Some(3)));
        for _ in 1..TIMES_BETTER {
            sizes.share_equally(&wanted(&[1.0; 16]), 5);
            assert_eq!(sizes.level(3), Some(3));
        }
        sizes.share_equally(&wanted(&[1.0; 16]), 5);
        assert_eq!(sizes.level(3), Some(2));
        sizes.share_equally(&wanted(&[1.0; 65]), 5);
        assert_eq!(sizes.level(3), Some(4));
    }
}
