//! What may change a cascade's extent: what is seen, or nothing at all.

/// How a cascade's extent follows the camera. Edges of shadows stand still in the world either way while the extent does not
/// change: windows move by whole texels.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum Stability {
    /// As tight as the receivers and casters in view allow, in steps of 19 %. A step is seen as edges that sharpen or blur a
    /// little at once; a camera that walks and turns through a town takes one in a few frames of a hundred.
    #[default]
    Rungs,
    /// A sphere around each slice of the camera's own volume, receivers or none: the extent depends on the projection and the
    /// distance limit alone, so that no motion of the camera changes it. (But texels are never finer than four ulps of the
    /// largest render coordinate in the window, 1 mm at 2 km: far out, let `origin` follow the camera.) A quarter as many
    /// texels fall on what is seen. Needs a far plane or a `max_distance`.
    Rotation,
}
