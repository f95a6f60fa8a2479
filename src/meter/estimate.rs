//! Estimates means of samples, with confidence intervals, and forgets old samples.

/// Is an estimate with the interval in which the value lies with a confidence of 95 %.
///
/// The interval is that of Wilson (1927), which inverts a score test instead of adding a standard
/// error to the estimate: it holds where few samples have an error, and none at all gives no
/// interval of width 0. Wilson's samples are 0 or 1. Those of a soft edge lie between, and their
/// variance is smaller: for samples `x` in 0..1 with the mean `m`, it is `E[x²] - m² = r m - m²`
/// with `r = E[x²] / E[x]`, where Wilson has `r = 1`. Half an error of full size is added to the
/// sums from which `r` is estimated, as Jeffreys' prior adds half an event, so that few small
/// errors do not rule out that larger ones are still unseen; without it, intervals of few errors hold the value in 86 % of cases instead of 95 %.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Estimate {
    /// Is the estimate; 0 without samples.
    pub value: f64,
    /// Is the lower end of the interval; 0 without samples.
    pub low: f64,
    /// Is the upper end of the interval; 1 without samples.
    pub high: f64,
}

/// Is the quantile of the normal distribution for a two-sided confidence of 95 %.
const QUANTILE_95: f64 = 1.959_963_985;

/// Is the weighted mean of samples whose weights fall as they grow old.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct RunningMean {
    /// Is the sum of the weights.
    weight: f64,
    /// Is the sum of the squared weights.
    weight_squared: f64,
    /// Are sums over the samples above 0 and of their squares.
    above: [f64; 2],
    /// Are sums over the samples below 0 and of their squares.
    below: [f64; 2],
}

impl RunningMean {
    /// Adds a sample of weight 1, at most 1.
    pub(super) fn add(&mut self, sample: f64) {
        self.weight += 1.0;
        self.weight_squared += 1.0;
        let side = if sample < 0.0 {
            &mut self.below
        } else {
            &mut self.above
        };
        side[0] += sample;
        side[1] += sample * sample;
    }

    /// Multiplies the weights of all samples.
    pub(super) fn scale(&mut self, factor: f64) {
        self.weight *= factor;
        self.weight_squared *= factor * factor;
        for sum in self.above.iter_mut().chain(&mut self.below) {
            *sum *= factor;
        }
    }

    /// Returns the number of samples of equal weight that would tell as much (Kish 1965).
    pub(super) fn effective_samples(&self) -> f64 {
        if self.weight_squared > 0.0 {
            self.weight * self.weight / self.weight_squared
        } else {
            0.0
        }
    }

    /// Returns the estimate of the mean, in 0..1.
    pub(super) fn estimate(&self) -> Estimate {
        let count = self.effective_samples();
        if count == 0.0 {
            return Estimate {
                value: 0.0,
                low: 0.0,
                high: 1.0,
            };
        }
        let mean = (self.above[0] + self.below[0]) / self.weight;
        // The score test solves n (mean - m)² = z² (c + r m - m²) for m. Samples below 0, which
        // two rays toward a light with an extent give, add c to the variance whatever the mean.
        let constant = self.below[1] / self.weight;
        let per_weight = count / self.weight;
        let [sum, squares] = self.above.map(|sum| sum * per_weight);
        let ratio = (squares + 0.5) / (sum + 0.5);
        let z2 = QUANTILE_95 * QUANTILE_95;
        let a = count + z2;
        let b = 2.0 * count * mean + z2 * ratio;
        let c = count * mean * mean - z2 * constant;
        let root = (b * b - 4.0 * a * c).max(0.0).sqrt();
        let within = |value: f64| value.clamp(0.0, 1.0);
        Estimate {
            value: within(mean),
            low: within((b - root) / (2.0 * a)),
            high: within((b + root) / (2.0 * a)),
        }
    }
}

impl Estimate {
    /// Returns the estimate of the square root.
    pub(super) fn sqrt(self) -> Self {
        Self {
            value: self.value.sqrt(),
            low: self.low.sqrt(),
            high: self.high.sqrt(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::RunningMean;

    fn mean_of(hits: u32, count: u32) -> RunningMean {
        let mut mean = RunningMean::default();
        for sample in 0..count {
            mean.add(f64::from(u8::from(sample < hits)));
        }
        mean
    }

    /// Compares with Wilson's interval by R's `prop.test(x, n, correct = FALSE)`.
    #[test]
    fn samples_of_0_and_1_have_wilsons_interval() {
        for (hits, low, high) in [
            (0, 0.0, 0.036_993_5),
            (1, 0.001_767, 0.054_486),
            (50, 0.403_832, 0.596_168),
        ] {
            let estimate = mean_of(hits, 100).estimate();
            assert!((estimate.low - low).abs() < 1e-5, "{hits}: {estimate:?}");
            assert!((estimate.high - high).abs() < 1e-5, "{hits}: {estimate:?}");
        }
    }

    /// Half an error of full size, added to 7000 samples of ¼, changes `r` by 1/1100, and the ends
    /// of the interval, which is 5 % of the mean wide, by less than 1/10 000.
    #[test]
    fn scaled_samples_have_a_scaled_interval() {
        let mut small = RunningMean::default();
        for sample in 0..100_000 {
            small.add(if sample < 7000 { 0.25 } else { 0.0 });
        }
        let (small, whole) = (small.estimate(), mean_of(7000, 100_000).estimate());
        assert!((small.low * 4.0 / whole.low - 1.0).abs() < 1e-4);
        assert!((small.high * 4.0 / whole.high - 1.0).abs() < 1e-4);
    }

    #[test]
    fn old_samples_count_less() {
        let mut mean = mean_of(100, 100);
        mean.scale(0.5);
        assert!((mean.effective_samples() - 100.0).abs() < 1e-9);
        for _ in 0..50 {
            mean.add(0.0);
        }
        assert!((mean.estimate().value - 0.5).abs() < 1e-12);
        assert!((mean.effective_samples() - 100.0 * 100.0 / 75.0).abs() < 1e-9);
    }

    #[test]
    fn nothing_is_known_without_samples() {
        let estimate = RunningMean::default().estimate();
        assert!(estimate.low == 0.0 && estimate.high == 1.0);
    }
}
