//! The filters: which texels of a map count for a receiver, and how much.

/// `SHADOW_PENUMBRA_REACH` of the shader, and a texel for its bilinear taps.
const PENUMBRA_REACH_TEXELS: f64 = 33.0;

/// How a receiver looks a map up.
///
/// | filter | texels | texture instructions | reach (texels) |
/// |---|---|---|---|
/// | `Nearest` | 1 | 1 gather | 0.5 |
/// | `Hardware` | 4 | 1 comparison | 1 |
/// | `Box` | 9 | 4 gathers | 1.5 |
/// | `Bilinear` | 4 | 1 gather | 1 |
/// | `Tent3` | 16 | 4 gathers | 2 |
/// | `Tent5` | 36 | 9 gathers | 3 |
/// | `Tent7` | 64 | 16 gathers | 4 |
/// | `Pcss`, `PcssRotated` | 240 | 60 gathers | 32 |
/// | `DirectionGrid` | 64 | 64 gathers | 0.5 a sample |
/// | `DirectionStar` | 20 | 20 gathers | 0.5 a sample |
///
/// Where shaders cannot gather (OpenGL ES 3.0, WebGL 2), a gather is four samples, one for `Nearest` and directions if the
/// compiler sees that the others are not used.
///
/// A sharpness of 1 leaves a kernel's ramp as it is; a larger one stretches it around one half, `(v - ½) · sharpness + ½`, so
/// that an edge is placed as well as by the wide kernel and blurred as little as by a narrow one. Below 1 a shadow never
/// becomes fully dark; very large values bring the stairs of `Nearest` back.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum Filter {
    /// One texel: hard stairs, for debugging and for maps that are finer than the picture.
    Nearest,
    /// The sampler's 2×2 comparison: the cheapest smooth edge on a GPU, in steps as coarse as 1/16 on some.
    Hardware,
    /// The textbook's mean of 3×3 comparisons, in steps of 1/9.
    Box,
    /// 2×2 gathered texels, exact bilinear weights.
    Bilinear {
        /// Edge sharpness, at least 1.
        sharpness: f32,
    },
    /// Kernel 1 2 1 ("3×3") over 4×4 gathered texels.
    Tent3 {
        /// Edge sharpness, at least 1.
        sharpness: f32,
    },
    /// Kernel 1 3 4 3 1 ("5×5") over 6×6 gathered texels.
    Tent5 {
        /// Edge sharpness, at least 1.
        sharpness: f32,
    },
    /// Kernel 1 5 12 16 12 5 1 ("7×7") over 8×8 gathered texels.
    Tent7 {
        /// Edge sharpness, at least 1.
        sharpness: f32,
    },
    /// Soft shadows of a light with size (percentage-closer soft shadows, Fernando 2005), calibrated by the light's own size:
    /// sharp where caster and receiver touch, and as wide as the real penumbra away from it, up to 32 texels.
    ///
    /// Where a penumbra would be wider than that, it stays at 32 texels: a smaller map then shows more of it.
    Pcss {
        /// For directional lights the angular diameter in radians (the sun's is 0.0093), below π; for local lights the radius
        /// in world units. Above 0 and finite; too large a value blurs shadows away from their casters, too small a one makes
        /// them hard.
        light_size: f32,
    },
    /// `Pcss` with its taps turned by an angle of each half texel's own: grain in place of bands, for lights so large that
    /// penumbrae span some ten texels and more. The grain is fixed in the world and does not swim when the camera moves.
    PcssRotated {
        /// As for `Pcss`.
        light_size: f32,
    },
    /// Point lights only: the textbook's 4×4×4 nearest comparisons in a cube of directions around the receiver's own.
    ///
    /// A blur of constant width in the world, in steps of 1/64: for a soft look, at sixteen times the lookups of `Tent3`
    /// and more error against hard truth.
    DirectionGrid {
        /// Half the side of the cube in world units, above 0; the textbook has 0.1.
        radius: f32,
    },
    /// Point lights only: the textbook's nearest comparisons in 20 fixed directions, over a radius that grows with the distance
    /// from the viewer (by its share of the light's range, so not at all where the range is endless), where the frame
    /// tells of a camera.
    ///
    /// A third of the cost of `DirectionGrid`; its steps of 1/20 show as bands where the radius spans many texels.
    DirectionStar {
        /// Radius in world units next to the viewer, above 0; the textbook has 0.04.
        radius: f32,
    },
}

impl Default for Filter {
    /// `Tent3` sharpened three times: of the filters here the least error against ray-traced hard shadows for its cost
    /// (`cargo bench --bench speed_vs_error`).
    fn default() -> Self {
        Self::Tent3 { sharpness: 3.0 }
    }
}

impl Filter {
    /// Every filter that suits all kinds of light, the sharpened ones with a sharpness of 1.
    pub const PLANAR: &'static [Self] = &[
        Self::Nearest,
        Self::Hardware,
        Self::Box,
        Self::Bilinear { sharpness: 1.0 },
        Self::Tent3 { sharpness: 1.0 },
        Self::Tent5 { sharpness: 1.0 },
        Self::Tent7 { sharpness: 1.0 },
    ];

    /// Greatest distance per axis, in texels, from the place looked up to the centre of a texel that counts.
    pub const fn reach_texels(self) -> f64 {
        match self {
            Self::Nearest | Self::DirectionGrid { .. } | Self::DirectionStar { .. } => 0.5,
            Self::Hardware | Self::Bilinear { .. } => 1.0,
            Self::Box => 1.5,
            Self::Tent3 { .. } => 2.0,
            Self::Tent5 { .. } => 3.0,
            Self::Tent7 { .. } => 4.0,
            Self::Pcss { .. } | Self::PcssRotated { .. } => PENUMBRA_REACH_TEXELS,
        }
    }

    /// Edge sharpness; 1 for the filters that have none.
    pub const fn sharpness(self) -> f32 {
        match self {
            Self::Bilinear { sharpness }
            | Self::Tent3 { sharpness }
            | Self::Tent5 { sharpness }
            | Self::Tent7 { sharpness } => sharpness,
            // The tent that stands in where a penumbra is narrower than a texel.
            Self::Pcss { .. } | Self::PcssRotated { .. } => 3.0,
            Self::Nearest
            | Self::Hardware
            | Self::Box
            | Self::DirectionGrid { .. }
            | Self::DirectionStar { .. } => 1.0,
        }
    }

    /// Size of the light for [`Filter::Pcss`] and [`Filter::PcssRotated`]; 0 for the others.
    pub const fn light_size(self) -> f32 {
        match self {
            Self::Pcss { light_size } | Self::PcssRotated { light_size } => light_size,
            _ => 0.0,
        }
    }

    /// Radius in world units of the direction-space filters; 0 for the others.
    pub const fn radius_world(self) -> f32 {
        match self {
            Self::DirectionGrid { radius } | Self::DirectionStar { radius } => radius,
            _ => 0.0,
        }
    }

    /// The offsets of a direction-space filter: name of the WGSL function and their number.
    pub(crate) const fn directions(self) -> Option<(&'static str, u32)> {
        match self {
            Self::DirectionGrid { .. } => Some(("shadow_direction_grid", 64)),
            Self::DirectionStar { .. } => Some(("shadow_direction_star", 20)),
            _ => None,
        }
    }

    /// True where each texel is compared with a reference of its own, so that the receiver's plane can be followed.
    pub const fn compares_each_texel(self) -> bool {
        !matches!(self, Self::Hardware)
    }

    /// Texture instructions of one lookup.
    pub const fn texture_instructions(self) -> u32 {
        match self {
            Self::Nearest | Self::Hardware | Self::Bilinear { .. } => 1,
            Self::Box | Self::Tent3 { .. } => 4,
            Self::Tent5 { .. } => 9,
            Self::Tent7 { .. } => 16,
            Self::Pcss { .. } | Self::PcssRotated { .. } => 60,
            Self::DirectionGrid { .. } => 64,
            Self::DirectionStar { .. } => 20,
        }
    }

    /// Name of the WGSL module, and the sampler that its function takes.
    pub(crate) const fn wgsl(self) -> (&'static str, FilterSampler) {
        match self {
            Self::Nearest | Self::DirectionGrid { .. } | Self::DirectionStar { .. } => {
                ("filter_nearest", FilterSampler::Point)
            }
            Self::Hardware => ("filter_hardware", FilterSampler::Comparison),
            Self::Box => ("filter_box", FilterSampler::Point),
            Self::Bilinear { .. } => ("filter_bilinear", FilterSampler::Point),
            Self::Tent3 { .. } => ("filter_tent3", FilterSampler::Point),
            Self::Tent5 { .. } => ("filter_tent5", FilterSampler::Point),
            Self::Tent7 { .. } => ("filter_tent7", FilterSampler::Point),
            Self::Pcss { .. } => ("filter_pcss", FilterSampler::Point),
            Self::PcssRotated { .. } => ("filter_pcss_rotated", FilterSampler::Point),
        }
    }
}

/// The sampler that a filter's function takes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum FilterSampler {
    /// Linear, comparing.
    Comparison,
    /// Nearest: a gather fetches four texels with it whatever it filters.
    Point,
}
