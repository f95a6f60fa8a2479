//! Provides random numbers that are the same on every run and every machine.

use glam::DVec3;

/// Is SplitMix64 (Steele, Lea and Flood 2014): one word of state, good enough to scatter points.
pub struct Random(u64);

impl Random {
    pub const fn new(seed: u64) -> Self {
        Self(seed)
    }

    /// Returns 64 random bits.
    pub fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// Returns a number that is uniform in `0.0..1.0`.
    pub fn unit(&mut self) -> f64 {
        (self.bits() >> 11) as f64 / (1u64 << 53) as f64
    }

    /// Returns a number that is uniform in `from..to`.
    pub fn between(&mut self, from: f32, to: f32) -> f32 {
        from + (to - from) * self.unit() as f32
    }

    /// Returns true with the given probability.
    pub fn chance(&mut self, probability: f64) -> bool {
        self.unit() < probability
    }

    /// Returns a number that is uniform in `low..high`.
    pub fn range(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.unit()
    }

    /// Returns a number that is uniform in `0..count`.
    pub fn index(&mut self, count: usize) -> usize {
        (self.unit() * count as f64) as usize
    }

    /// Returns a point that is uniform in a box.
    pub fn point(&mut self, low: DVec3, high: DVec3) -> DVec3 {
        DVec3::new(
            self.range(low.x, high.x),
            self.range(low.y, high.y),
            self.range(low.z, high.z),
        )
    }

    /// Returns a direction that is uniform over the unit sphere.
    pub fn direction(&mut self) -> DVec3 {
        let y = self.range(-1.0, 1.0);
        let angle = self.range(0.0, std::f64::consts::TAU);
        let radius = (1.0 - y * y).sqrt();
        DVec3::new(radius * angle.cos(), y, radius * angle.sin())
    }
}
