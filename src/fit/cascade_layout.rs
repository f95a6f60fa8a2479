//! Selects how texels are divided among cascades.

use crate::fit::split::CascadeSplit;

/// Selects how many cascades a directional light has, and how its texels are divided among them.
/// [`DirectionalShadow::new`](crate::DirectionalShadow::new) returns
/// [`ShadowError::OutOfRange`](crate::ShadowError::OutOfRange) for numbers outside the ranges given
/// here.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum CascadeLayout<'a> {
    /// Divides one layer of `map_size`² texels among at most `max_cascades` cascades. How many
    /// there are, where they end, and how many texels each gets follows from what the cameras see.
    /// This is the default, with at most 4.
    ///
    /// Every 16 frames, the error of shadows is predicted for possible layouts from the points at
    /// which some hundreds of rays through the images meet the bounds of receivers. A point counts
    /// where the bounds of a caster lie between it and the light. The squared error is taken to be
    /// 0.095 times the density of shadow edges times the size of a texel, both in pixels; the
    /// factor was measured for the default filter. The density is taken from the outlines of the
    /// bounds of casters, and is assumed to grow with the world size of a pixel to the power of
    /// 2/3.
    ///
    /// A cascade more is used where it lowers the predicted error by at least 4 percent. The layout
    /// changes when another one has been better by 15 percent for 128 frames, or at once where
    /// another halves the error, as after a cut of the camera. All cascades are drawn when it
    /// changes. The same frames always lead to the same layouts.
    ///
    /// All that is predicted follows from bounds. Casters whose bounds hold much more than their
    /// surfaces, such as a town in one mesh, are judged too simply: there, four fixed cascades may
    /// have a lower error with as many texels.
    /// [`predicted_error`](crate::report::ShadowReport::predicted_error) tells what was expected.
    ///
    /// Without a camera, one cascade has all texels. A map of fewer than some 200 texels a side is
    /// not divided, since the borders of its parts would take too many of them.
    Automatic {
        /// Is the largest number of cascades, 1..=8. A lookup costs as much as with that many
        /// fixed ones. With 1, no texels are ever divided; with more than 4, few scenes gain.
        max_cascades: u32,
    },
    /// Gives every cascade a layer of its own, with `map_size`² texels each. It suits scenes whose
    /// depths are known beforehand, and casters in few meshes with wide bounds.
    Fixed {
        /// Is the number of cascades: 1..=8, and no more than the device's
        /// `max_texture_array_layers`. One suits a scene that is as deep as it is wide; a view to
        /// the horizon needs 3 or 4. With too few, texels are coarse near the camera.
        cascades: u32,
        /// Selects where one cascade ends and the next begins.
        split: CascadeSplit<'a>,
    },
}

impl CascadeLayout<'_> {
    /// Makes a layout of `cascades` cascades with a layer each, whose ends are
    /// [logarithmic](CascadeSplit::Logarithmic).
    pub const fn fixed(cascades: u32) -> Self {
        Self::Fixed {
            cascades,
            split: CascadeSplit::Logarithmic,
        }
    }

    /// Returns whether texels are divided by predicted error.
    pub(crate) const fn is_automatic(&self) -> bool {
        matches!(self, Self::Automatic { .. })
    }

    /// Returns the largest number of cascades.
    pub(crate) const fn most_cascades(&self) -> u32 {
        match self {
            Self::Automatic { max_cascades } => *max_cascades,
            Self::Fixed { cascades, .. } => *cascades,
        }
    }

    /// Returns where fixed cascades end; without meaning for those that are found.
    pub(crate) const fn split(&self) -> CascadeSplit<'_> {
        match self {
            Self::Automatic { .. } => CascadeSplit::Logarithmic,
            Self::Fixed { split, .. } => *split,
        }
    }
}

impl Default for CascadeLayout<'_> {
    /// Returns an automatic layout of at most 4 cascades.
    fn default() -> Self {
        Self::Automatic { max_cascades: 4 }
    }
}
