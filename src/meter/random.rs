//! Generates random numbers.

/// Is SplitMix64 (Steele, Lea and Flood 2014): one word of state, good enough to scatter points.
#[derive(Clone, Debug, Default)]
pub(crate) struct Random(u64);

impl Random {
    /// Returns 64 random bits.
    fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// Returns a number that is uniform in `0.0..1.0`.
    pub(super) fn unit(&mut self) -> f64 {
        (self.bits() >> 11) as f64 / (1u64 << 53) as f64
    }

    /// Returns a point that is uniform in the unit disc.
    pub(super) fn on_disc(&mut self) -> [f64; 2] {
        let (radius, angle) = (self.unit().sqrt(), self.unit() * std::f64::consts::TAU);
        [radius * angle.cos(), radius * angle.sin()]
    }
}
