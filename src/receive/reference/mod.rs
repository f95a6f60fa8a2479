//! Contains the CPU reference of the WGSL: the arithmetic of a lookup in f64, which returns what
//! the shader should return for the texels that a map contains.
//!
//! It serves the tests of engines and of the library, which compare the device's results with it.
//! Kernels are computed here by their definition, a bilinear comparison convolved with a row of
//! integers, and not by the shader's closed form.
//!
//! No input makes these functions panic.

mod filter;
mod receiver;

use glam::DVec2;

pub use filter::visibility;
pub use receiver::{holds, receiver, weight};

/// Holds one layer of a depth map as read back from the device: rows from the top, in ndc depth
/// (reversed: near 1, far 0).
#[derive(Clone, Copy, Debug)]
pub struct DepthLayer<'a> {
    /// Is the number of texels per side. Any size is accepted, whatever the length of `depths`.
    pub size: u32,
    /// Holds `size * size` depths. Missing depths count as 0, at which nothing casts.
    pub depths: &'a [f32],
}

impl DepthLayer<'_> {
    /// Returns the depth of a texel. Beyond the sides it is that of the nearest texel inside, as
    /// the samplers clamp.
    fn depth(&self, x: i64, y: i64) -> f64 {
        let last = (i64::from(self.size) - 1).max(0);
        let [row, column] = [y, x].map(|texel| texel.clamp(0, last).unsigned_abs());
        // The index is below the square of the size, which fits into an unsigned integer of 64
        // bits.
        let index = row * u64::from(self.size) + column;
        let index = usize::try_from(index).unwrap_or(usize::MAX);
        f64::from(self.depths.get(index).copied().unwrap_or(0.0))
    }
}

/// Holds the position of a receiver in a map, as `ShadowReceiver` in `wgsl/view.wgsl` does.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Receiver {
    /// Is the position in texel coordinates: origin at the top left, centres at halves.
    pub texel: DVec2,
    /// Is the reference depth at `texel` in ndc, with the bias included.
    pub depth: f64,
    /// Is the change of the reference depth per texel along x and y.
    pub gradient: DVec2,
    /// Is the radius of a penumbra in texels per difference of ndc depth.
    pub penumbra: DVec2,
    /// Is the position of the map's first texel in a grid that is fixed in the world, as the member
    /// `grid` of the WGSL struct `ShadowViewUniform` has it.
    pub grid: u32,
    /// Is the result of [`holds`] for the receiver's position. Where it is false, visibility is 1.
    pub inside: bool,
}
