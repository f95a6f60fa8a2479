//! Selects how texels are divided among cascades.

/// Selects how the texels of a directional light are divided among its cascades.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum CascadeLayout {
    /// Gives every cascade a layer of its own, with `map_size`² texels each. The number of cascades
    /// is fixed, and [`CascadeSplit`](crate::CascadeSplit) tells where they end. This is the
    /// default.
    #[default]
    Fixed,
    /// Divides one layer of `map_size`² texels among at most as many cascades as the light has. How
    /// many there are, where they end, and how many texels each gets follows from what the cameras
    /// see; [`CascadeSplit`](crate::CascadeSplit) has no effect.
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
    /// surfaces, such as a town in one mesh, are judged too simply: there, a fixed layout of four
    /// cascades may have a lower error with as many texels.
    /// [`predicted_error`](crate::report::ShadowReport::predicted_error) tells what was expected.
    ///
    /// Without a camera, one cascade has all texels. A map of fewer than some 200 texels a side is
    /// not divided, since the borders of its parts would take too many of them.
    Automatic,
}
