//! Defines the filters: which texels of a map a lookup reads, and with which weights.

/// Is the shader's `SHADOW_PENUMBRA_REACH` and one texel more for its bilinear taps.
const PENUMBRA_REACH_TEXELS: f64 = 33.0;

/// Selects how a receiver samples a map. The default is `Tent3` with a sharpness of 3.
///
/// The reach in this table is that of [`Filter::reach_texels`]; the counts of `Pcss` are the
/// largest that a lookup needs. The cycles are those of a wave of 32 pixels on an RDNA 2 SIMD, of a
/// whole lookup under a sun with one cascade, by its compiler's model (`cargo bench --bench lookup`
/// in the repository); the textbook's 3×3 comparisons take 121, and an empty shader takes 12.
///
/// | filter | texels | texture instructions | cycles | reach (texels) |
/// |---|---|---|---|---|
/// | `Nearest` | 1 | 1 gather | 141 | 0.5 |
/// | `Hardware` | 4 | 1 comparison | 104 | 1 |
/// | `Box` | 9 | 4 gathers | 205 | 1.5 |
/// | `Bilinear` | 4 | 1 gather | 169 | 1 |
/// | `Tent3` | 16 | 4 gathers | 269 | 2 |
/// | `Tent5` | 36 | 9 gathers | 436 | 3 |
/// | `Tent7` | 64 | 16 gathers | 676 | 4 |
/// | `Pcss`, `PcssRotated` | 240 | 60 gathers | loops | 33 |
/// | `DirectionGrid` | 64 | 64 gathers | loops | 0.5 per sample |
/// | `DirectionStar` | 20 | 20 gathers | loops | 0.5 per sample |
///
/// Where shaders cannot gather (OpenGL ES 3.0, WebGL 2), a gather becomes four samples. For
/// `Nearest` and the direction filters it becomes one, if the compiler removes the three that are
/// not used.
///
/// A sharpness of 1 leaves a kernel's ramp of visibilities `v` as it is. A larger one stretches the
/// ramp around one half, `(v - ½) · sharpness + ½`, so that an edge is as accurately placed as by
/// the wide kernel and as little blurred as by a narrow one. Very large values bring back the
/// stairs of `Nearest`. Values below 1, under which no shadow would become fully dark, are refused.
///
/// A parameter outside its range makes the constructor of a light return
/// [`ShadowError::OutOfRange`](crate::ShadowError::OutOfRange).
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum Filter {
    /// Compares with one texel. Edges are hard stairs; this suits debugging, and maps that are
    /// finer than the image.
    Nearest,
    /// Uses the sampler's own 2×2 comparison: the cheapest smooth edge on a GPU, with weights as
    /// coarse as 1/16 on some.
    Hardware,
    /// Averages 3×3 nearest comparisons (percentage-closer filtering, Reeves et al. 1987, in the
    /// form of the tutorial at learnopengl.com), in steps of 1/9.
    Box,
    /// Compares 2×2 gathered texels and weights the results bilinearly, in full precision.
    Bilinear {
        /// Is the edge sharpness, at least 1 and finite.
        sharpness: f32,
    },
    /// Applies the kernel 1 2 1 ("3×3") per axis to bilinear comparisons, over 4×4 gathered texels
    /// (Castaño 2013).
    Tent3 {
        /// Is the edge sharpness, at least 1 and finite.
        sharpness: f32,
    },
    /// Applies the kernel 1 3 4 3 1 ("5×5") per axis to bilinear comparisons, over 6×6 gathered
    /// texels (Castaño 2013).
    Tent5 {
        /// Is the edge sharpness, at least 1 and finite.
        sharpness: f32,
    },
    /// Applies the kernel 1 5 12 16 12 5 1 ("7×7") per axis to bilinear comparisons, over 8×8
    /// gathered texels (Castaño 2013).
    Tent7 {
        /// Is the edge sharpness, at least 1 and finite.
        sharpness: f32,
    },
    /// Renders soft shadows of a light with a size (percentage-closer soft shadows, Fernando 2005),
    /// calibrated by the size of the light: an edge is sharp where caster and receiver touch, and
    /// elsewhere as wide as the real penumbra, up to a radius of 32 texels.
    ///
    /// A penumbra that would be wider stays at 32 texels; a smaller map then shows more of it.
    Pcss {
        /// Is the size of the light, above 0 and finite. For directional lights it is the angular
        /// diameter in radians (the sun's is 0.0093), below π; for local lights it is the radius in
        /// world units. Too large a value blurs shadows away from their casters; too small a one
        /// makes their edges hard.
        light_size: f32,
    },
    /// Renders as `Pcss` does, with the sample pattern rotated by an angle that differs for each
    /// half texel. Noise then replaces banding, for lights so large that penumbrae span some ten
    /// texels and more. The noise is fixed in the world and does not swim when the camera moves.
    PcssRotated {
        /// Is the size of the light, as for `Pcss`.
        light_size: f32,
    },
    /// Averages 4×4×4 nearest comparisons in a cube of directions around the receiver's own, as the
    /// tutorial at learnopengl.com does; for point lights only.
    ///
    /// It blurs by a constant width in the world, in steps of 1/64, for a soft look. It takes
    /// sixteen times the gathers of `Tent3` and has a larger error against ray-traced hard shadows.
    DirectionGrid {
        /// Is half the side of the cube in world units, above 0 and finite; the tutorial uses 0.1.
        /// Too large a value blurs shadows at contacts as well.
        radius: f32,
    },
    /// Point lights only: the textbook's nearest comparisons in 20 fixed directions, over a radius
    /// that grows with the distance from the viewer (by its share of the light's range, so not at
    /// all where the range is endless), where the frame tells of a camera.
    ///
    /// It takes a third of the gathers of `DirectionGrid`. Its steps of 1/20 show as bands where
    /// the radius spans many texels.
    DirectionStar {
        /// Is the radius in world units next to the camera, above 0 and finite; the tutorial uses
        /// 0.04.
        radius: f32,
    },
}

impl Default for Filter {
    /// Returns `Tent3` with a sharpness of 3: at its cost, no filter here has a smaller error
    /// against ray-traced hard shadows (`cargo bench --bench speed_vs_error`).
    fn default() -> Self {
        Self::Tent3 { sharpness: 3.0 }
    }
}

impl Filter {
    /// Lists the filters of hard shadows that all kinds of light accept, those with a sharpness at
    /// a sharpness of 1.
    pub const PLANAR: &'static [Self] = &[
        Self::Nearest,
        Self::Hardware,
        Self::Box,
        Self::Bilinear { sharpness: 1.0 },
        Self::Tent3 { sharpness: 1.0 },
        Self::Tent5 { sharpness: 1.0 },
        Self::Tent7 { sharpness: 1.0 },
    ];

    /// Returns the greatest distance per axis, in texels, from the sampled position to the centre
    /// of a texel that the lookup reads with a weight above 0.
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

    /// Returns the edge sharpness: 1 for the filters that have none, and 3 for [`Filter::Pcss`] and
    /// [`Filter::PcssRotated`], whose penumbrae below one texel use `Tent3`.
    pub const fn sharpness(self) -> f32 {
        match self {
            Self::Bilinear { sharpness }
            | Self::Tent3 { sharpness }
            | Self::Tent5 { sharpness }
            | Self::Tent7 { sharpness } => sharpness,
            // This is the sharpness of the tent kernel that replaces penumbrae narrower than a
            // texel.
            Self::Pcss { .. } | Self::PcssRotated { .. } => 3.0,
            Self::Nearest
            | Self::Hardware
            | Self::Box
            | Self::DirectionGrid { .. }
            | Self::DirectionStar { .. } => 1.0,
        }
    }

    /// Returns the factor and the summand that turn the weighted sum of a kernel's comparisons,
    /// with integer weights along each axis, into visibility: a ramp through one half at half of
    /// the sum.
    pub(crate) fn ramp(self) -> [f64; 2] {
        let side = match self {
            Self::Box => 3.0,
            Self::Tent3 { .. } | Self::Pcss { .. } | Self::PcssRotated { .. } => 4.0,
            Self::Tent5 { .. } => 12.0,
            Self::Tent7 { .. } => 52.0,
            Self::Nearest
            | Self::Hardware
            | Self::Bilinear { .. }
            | Self::DirectionGrid { .. }
            | Self::DirectionStar { .. } => 1.0,
        };
        let sharpness = f64::from(self.sharpness());
        [sharpness / (side * side), 0.5 - 0.5 * sharpness]
    }

    /// Returns the size of the light for [`Filter::Pcss`] and [`Filter::PcssRotated`]: radians of
    /// angular diameter for directional lights, world units of radius for local ones. It is 0 for
    /// the other filters.
    pub const fn light_size(self) -> f32 {
        match self {
            Self::Pcss { light_size } | Self::PcssRotated { light_size } => light_size,
            _ => 0.0,
        }
    }

    /// Returns the radius in world units of [`Filter::DirectionGrid`] and
    /// [`Filter::DirectionStar`]; 0 for the other filters.
    pub const fn radius_world(self) -> f32 {
        match self {
            Self::DirectionGrid { radius } | Self::DirectionStar { radius } => radius,
            _ => 0.0,
        }
    }

    /// Returns the pattern of a direction-space filter (what follows `shadow_direction_` in the
    /// name of the WGSL function that returns its offsets) and the number of offsets. It is `None`
    /// for all other filters.
    pub(crate) const fn directions(self) -> Option<(&'static str, u32)> {
        match self {
            Self::DirectionGrid { .. } => Some(("grid", 64)),
            Self::DirectionStar { .. } => Some(("star", 20)),
            _ => None,
        }
    }

    /// Returns whether each texel is compared with a reference depth of its own, so that
    /// [`Bias::Auto`](crate::Bias::Auto) can use the receiver's tangent plane.
    pub const fn compares_each_texel(self) -> bool {
        !matches!(self, Self::Hardware)
    }

    /// Returns the number of texture instructions of one lookup (at most so many for
    /// [`Filter::Pcss`] and [`Filter::PcssRotated`]), on a device whose shaders can gather.
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

    /// Returns the name of the WGSL module and the sampler that its function takes.
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

/// Selects the sampler that a filter's function takes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum FilterSampler {
    /// Compares, with linear filtering.
    Comparison,
    /// Does not compare, and filters to the nearest texel. A gather fetches four texels whatever
    /// the filtering.
    Point,
}
