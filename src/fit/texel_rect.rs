//! Defines the rectangle of a layer that a view is rendered into.

use glam::UVec2;

/// Is a rectangle of texels in a layer of a light's depth texture, whose first texel is at the top
/// left.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct TexelRect {
    /// Is the column and the row of the first texel.
    pub min: UVec2,
    /// Counts the texels along x and y.
    pub size: UVec2,
}

impl TexelRect {
    /// Returns a whole layer of `map_size` texels a side.
    pub(crate) const fn whole(map_size: u32) -> Self {
        Self {
            min: UVec2::ZERO,
            size: UVec2::splat(map_size),
        }
    }
}
