//! How a receiver is kept from shadowing itself.

use std::f64::consts::SQRT_2;

use crate::fit::ShadowView;
use crate::receive::Filter;

/// Residual offset along the normal that [`Bias::Auto`] adds to the plane, in texels times |nx| + |ny| of the normal in light
/// space: for facets finer than a texel and for open sheets, where a texel holds more than the receiver's own plane. With none,
/// fine meshes show specks of acne; from twice as much on, thin things lose more of their contact than that is worth.
const RESIDUAL_OFFSET_TEXELS: f64 = 0.1;

/// Vertices snap to 1/256 of a texel, once for the caster's edge and once for its neighbour's.
const VERTEX_SNAP_TEXELS: f64 = 1.0 / 256.0;

/// The bias of a light.
///
/// Too little bias shows as *acne*: stripes or speckles of shadow on lit surfaces. Too much shows as *peter-panning*: light
/// under the feet of things, shadows that begin a step away. Normals are geometric and on the side that is shaded
/// (`shadow_geometric_normal(position, toward_viewer)` makes them from derivatives); smooth shading normals bring acne back by the
/// angle between facets, and normals on the other side bring it back everywhere.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[non_exhaustive]
pub enum Bias {
    /// Derived, nothing to tune. Filters that compare each texel by itself follow the receiver's tangent plane (Dou et al.
    /// 2014), clamped toward the light, with an offset for rounding only; [`Filter::Hardware`] takes [`Bias::NormalOffset`].
    #[default]
    Auto,
    /// The least offset along the normal that frees a plane of self-shadowing under the whole kernel: `K · s · (|nx| + |ny|)`,
    /// K the filter's reach, s the world size of a texel, n the normal in light space. Casters thinner than this that lie on
    /// a surface cast nothing onto it.
    NormalOffset,
    /// The textbook's `max(slope · (1 − n·l), constant)` toward the light, in world units: to be tuned by hand, for each
    /// scene and each map size.
    Manual {
        /// Least offset in world units, at least 0.
        constant: f32,
        /// Offset in world units at grazing incidence, at least 0.
        slope: f32,
    },
}

/// The WGSL scheme that a bias comes to under a filter.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum BiasScheme {
    Plane,
    NormalOffset,
    Manual,
}

impl BiasScheme {
    /// Name of the WGSL module; its function is `shadow_receiver_` and what follows `bias_`.
    pub const fn module(self) -> &'static str {
        match self {
            Self::Plane => "bias_plane",
            Self::NormalOffset => "bias_normal_offset",
            Self::Manual => "bias_manual",
        }
    }

    /// Name of the WGSL function that makes a receiver.
    pub const fn function(self) -> &'static str {
        match self {
            Self::Plane => "shadow_receiver_plane",
            Self::NormalOffset => "shadow_receiver_normal_offset",
            Self::Manual => "shadow_receiver_manual",
        }
    }
}

impl Bias {
    pub(crate) const fn scheme(self, filter: Filter) -> BiasScheme {
        match self {
            Self::Auto if filter.compares_each_texel() => BiasScheme::Plane,
            Self::Auto | Self::NormalOffset => BiasScheme::NormalOffset,
            Self::Manual { .. } => BiasScheme::Manual,
        }
    }

    /// Offset along the normal, in texels times |nx| + |ny|.
    pub(crate) fn offset_texels(self, filter: Filter) -> f64 {
        match self.scheme(filter) {
            BiasScheme::Plane => RESIDUAL_OFFSET_TEXELS,
            BiasScheme::NormalOffset => filter.reach_texels(),
            BiasScheme::Manual => 0.0,
        }
    }

    /// Manual constant and slope in world units; zero for the derived schemes.
    pub(crate) const fn manual(self) -> (f32, f32) {
        match self {
            Self::Manual { constant, slope } => (constant, slope),
            Self::Auto | Self::NormalOffset => (0.0, 0.0),
        }
    }

    /// Height in world units above which a caster that lies on a surface always casts its full shadow onto it, at the worst
    /// angle of the light: the size of the gap that the bias can leave.
    pub(crate) fn max_peter_panning_world(self, filter: Filter, view: &ShadowView) -> f32 {
        let texel = f64::from(view.texel_size_world().max_element());
        // Once for the receiver, which gives way by so much, and once for the caster, which may lie that much lower.
        let rounding = 2.0 * (view.depth_error_world() + view.largest_position_error_world());
        let lateral = lateral_error_texels(view);
        let lift = match self {
            Self::Manual { constant, slope } => f64::from(constant.max(slope)),
            Self::Auto | Self::NormalOffset => self.offset_texels(filter) * texel * SQRT_2,
        };
        // One more reach of the filter: a texel on the side where the surface falls away is compared with the receiver's own
        // depth, or with its one offset depth, which there lies that much further above the surface.
        let gap = lift + (filter.reach_texels() + lateral) * texel * SQRT_2 + rounding;
        gap as f32
    }
}

/// Error across the map of a lookup against what was rasterised, in texels.
pub(crate) fn lateral_error_texels(view: &ShadowView) -> f64 {
    VERTEX_SNAP_TEXELS + view.lateral_error_texels()
}
