//! Selects whether a cascade's extent may follow what is seen, or does not change at all.

/// Selects how a cascade's extent follows the camera. In both cases edges of shadows keep their
/// positions in the world while the extent does not change: map rectangles move by whole texels.
/// The default is `TightFit`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum Stability {
    /// Makes the extent as tight as the receivers and casters in view allow, in quantized size
    /// steps of 19 %. A step is seen as edges that sharpen or blur a little at once; a camera that
    /// walks and turns through a town causes one in a few frames of a hundred.
    #[default]
    TightFit,
    /// Uses a sphere around each slice of the camera's own volume, whether it has receivers or not:
    /// the extent depends on the projection and the distance limit alone, so that no motion of the
    /// camera changes it. There are two exceptions: under an orthographic camera the slices cover
    /// the depths at which receivers are visible, and change rarely; and texels are never finer
    /// than four ulps of the largest render coordinate within the map rectangle, which is 1 mm at 2
    /// km. Far from the origin, let `origin` follow the camera. A quarter as many texels fall on
    /// what is seen. It needs a far plane or a `max_distance`; without either, recording returns
    /// [`ShadowError::OutOfRange`](crate::ShadowError::OutOfRange).
    BoundingSphere,
}
