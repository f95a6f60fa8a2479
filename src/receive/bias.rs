//! Defines how a receiver is kept from shadowing itself.

use std::f64::consts::SQRT_2;

use crate::fit::ShadowView;
use crate::receive::Filter;

/// Is the residual offset along the normal that [`Bias::Auto`] adds to the tangent plane, in texels
/// times |nx| + |ny| of the normal in light space. It serves facets finer than a texel, and open
/// sheets, where a texel covers more than the receiver's own plane. Without it, fine meshes show
/// specks of acne; from twice as much on, thin objects lose more of their contact shadows than the
/// removed acne is worth.
const RESIDUAL_OFFSET_TEXELS: f64 = 0.1;

/// Is the error of rasterised edges in texels: a rasteriser snaps vertices to 1/256 of a texel,
/// which displaces by up to half of that the caster's edge and again its neighbour's.
const VERTEX_SNAP_TEXELS: f64 = 1.0 / 256.0;

/// Selects how a receiver is kept from shadowing itself.
///
/// Too little bias shows as *acne*: stripes or speckles of shadow on lit surfaces. Too much shows
/// as *peter-panning*: light under the feet of objects, and shadows that begin at a distance from
/// their casters. Normals must be geometric and on the side that is shaded
/// (`shadow_geometric_normal(position, toward_viewer)` computes them from derivatives). Smooth
/// shading normals bring back acne in proportion to the angle between facets, and normals on the
/// other side bring it back everywhere.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[non_exhaustive]
pub enum Bias {
    /// Derives the bias, with no parameter to tune. Filters that compare each texel by itself
    /// compare it with the receiver's tangent plane (Dou et al. 2014), clamped toward the light,
    /// and offset the receiver only by a tenth of a texel and by rounding. [`Filter::Hardware`]
    /// uses [`Bias::NormalOffset`] instead. This is the default.
    #[default]
    Auto,
    /// Moves the receiver along its normal by the least offset that prevents self-shadowing of a
    /// plane under the whole kernel: `K · s · (|nx| + |ny|)`, where K is the filter's reach in
    /// texels, s the world size of a texel, and n the normal in light space. A caster that is
    /// thinner than this and lies on a surface casts no shadow onto it.
    NormalOffset,
    /// Moves the receiver toward the light by `max(slope · (1 − n·l), constant)` world units, as
    /// the tutorial at learnopengl.com does. Both parameters must be tuned by hand for each scene
    /// and each map size; values that are too small leave acne, and values that are too large cause
    /// peter-panning. A value that is negative or not finite is
    /// [`ShadowError::OutOfRange`](crate::ShadowError::OutOfRange).
    Manual {
        /// Is the least offset in world units, at least 0 and finite.
        constant: f32,
        /// Is the offset in world units at grazing incidence, at least 0 and finite.
        slope: f32,
    },
}

/// Selects the WGSL function that computes a receiver. It follows from the bias and the filter.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum BiasScheme {
    Plane,
    NormalOffset,
    Manual,
}

impl BiasScheme {
    /// Returns the name of the WGSL module.
    pub(crate) const fn module(self) -> &'static str {
        match self {
            Self::Plane => "bias_plane",
            Self::NormalOffset => "bias_normal_offset",
            Self::Manual => "bias_manual",
        }
    }

    /// Returns what follows `shadow_receiver_` in the name of the WGSL function that makes a
    /// receiver.
    pub(crate) const fn name(self) -> &'static str {
        match self {
            Self::Plane => "plane",
            Self::NormalOffset => "normal_offset",
            Self::Manual => "manual",
        }
    }
}

impl Bias {
    /// Returns the scheme that the bias leads to under `filter`.
    pub(crate) const fn scheme(self, filter: Filter) -> BiasScheme {
        match self {
            Self::Auto if filter.compares_each_texel() => BiasScheme::Plane,
            Self::Auto | Self::NormalOffset => BiasScheme::NormalOffset,
            Self::Manual { .. } => BiasScheme::Manual,
        }
    }

    /// Returns the offset along the normal, in texels times |nx| + |ny| of the normal in light
    /// space.
    pub(crate) fn offset_texels(self, filter: Filter) -> f64 {
        match self.scheme(filter) {
            BiasScheme::Plane => RESIDUAL_OFFSET_TEXELS,
            BiasScheme::NormalOffset => filter.reach_texels(),
            BiasScheme::Manual => 0.0,
        }
    }

    /// Returns the constant and slope of a manual bias in world units; zero for the derived
    /// schemes.
    pub(crate) const fn manual(self) -> (f32, f32) {
        match self {
            Self::Manual { constant, slope } => (constant, slope),
            Self::Auto | Self::NormalOffset => (0.0, 0.0),
        }
    }

    /// Returns the height in world units above which a caster that lies on a surface always casts
    /// its full shadow onto it, at the worst angle of the light: the size of the gap that the bias
    /// can leave.
    pub(crate) fn max_peter_panning_world(self, filter: Filter, view: &ShadowView) -> f32 {
        let texel = f64::from(view.texel_size_world().max_element());
        // Rounding counts twice: the receiver is offset by it, and the caster may be stored that
        // much lower.
        let rounding = 2.0 * (view.depth_error_world() + view.largest_position_error_world());
        let lateral = lateral_error_texels(view);
        let lift = match self {
            Self::Manual { constant, slope } => f64::from(constant.max(slope)),
            Self::Auto | Self::NormalOffset => self.offset_texels(filter) * texel * SQRT_2,
        };
        // The filter's reach counts once more: a texel on the side where the surface recedes from
        // the light is compared with the receiver's own depth, or with its one offset depth, which
        // there lies that much farther above the surface.
        let gap = lift + (filter.reach_texels() + lateral) * texel * SQRT_2 + rounding;
        gap as f32
    }
}

/// Returns the error of a lookup's position across the map, in texels, in relation to what was
/// rasterised.
pub(crate) fn lateral_error_texels(view: &ShadowView) -> f64 {
    VERTEX_SNAP_TEXELS + view.lateral_error_texels()
}
