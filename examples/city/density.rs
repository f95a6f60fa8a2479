//! Measures how many texels of its map a pixel covers.

use std::fmt;

/// Holds quantiles over the pixels that a map covers.
pub struct Density {
    least: f32,
    median: f32,
    percentile_99: f32,
    most: f32,
    served_pixels: usize,
}

impl Density {
    /// Returns the quantiles of an image of `fragment_density`, whose red channel is
    /// `(log2(texels) + 8) / 16`, or 0 where no map covers the pixel.
    pub fn of(pixels: &[u8]) -> Option<Self> {
        let mut codes: Vec<u8> = pixels.iter().step_by(4).copied().collect();
        codes.retain(|code| *code > 0);
        codes.sort_unstable();
        let last = codes.len().checked_sub(1)?;
        let quantile = |share: f64| {
            let code = f32::from(codes[(last as f64 * share).round() as usize]);
            (code / 255.0 * 16.0 - 8.0).exp2()
        };
        Some(Self {
            least: quantile(0.0),
            median: quantile(0.5),
            percentile_99: quantile(0.99),
            most: quantile(1.0),
            served_pixels: codes.len(),
        })
    }
}

impl fmt::Display for Density {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "texels per pixel, to 4 %: {:.2} at least, median {:.2}, 99th percentile {:.2}, {:.2} at most, of {} pixels",
            self.least, self.median, self.percentile_99, self.most, self.served_pixels
        )
    }
}
