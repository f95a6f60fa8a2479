//! Computes medians and quartiles.

/// Holds the median and the middle half of a set of numbers.
#[derive(Clone, Copy, Debug)]
pub struct Spread {
    pub lower_quartile: f64,
    pub median: f64,
    pub upper_quartile: f64,
}

impl Spread {
    /// Is the result for an empty set.
    pub const UNKNOWN: Self = Self {
        lower_quartile: f64::NAN,
        median: f64::NAN,
        upper_quartile: f64::NAN,
    };

    /// Returns the statistics of at least one number.
    pub fn of(values: impl IntoIterator<Item = f64>) -> Self {
        let mut sorted: Vec<f64> = values.into_iter().collect();
        sorted.sort_by(f64::total_cmp);
        let quantile = |share: f64| {
            let place = share * (sorted.len() - 1) as f64;
            let (below, above) = (
                sorted[place.floor() as usize],
                sorted[place.ceil() as usize],
            );
            below + (above - below) * place.fract()
        };
        Self {
            lower_quartile: quantile(0.25),
            median: quantile(0.5),
            upper_quartile: quantile(0.75),
        }
    }
}
