//! The filters: which texels of a map count for a receiver, and how much.

/// How a receiver looks a map up.
///
/// | filter | texels | texture instructions | reach (texels) |
/// |---|---|---|---|
/// | `Nearest` | 1 | 1 load | 0.5 |
/// | `Hardware` | 4 | 1 comparison | 1 |
/// | `Box` | 9 | 9 loads | 1.5 |
/// | `Bilinear` | 4 | 1 gather | 1 |
/// | `TentNarrow` | 16 | 4 gathers | 2 |
/// | `TentMedium` | 36 | 9 gathers | 3 |
/// | `TentWide` | 64 | 16 gathers | 4 |
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
    TentNarrow {
        /// Edge sharpness, at least 1.
        sharpness: f32,
    },
    /// Kernel 1 3 4 3 1 ("5×5") over 6×6 gathered texels.
    TentMedium {
        /// Edge sharpness, at least 1.
        sharpness: f32,
    },
    /// Kernel 1 5 12 16 12 5 1 ("7×7") over 8×8 gathered texels.
    TentWide {
        /// Edge sharpness, at least 1.
        sharpness: f32,
    },
}

impl Default for Filter {
    /// `TentNarrow` sharpened three times: the least error against ray-traced hard shadows of all that were tried.
    fn default() -> Self {
        Self::TentNarrow { sharpness: 3.0 }
    }
}

impl Filter {
    /// Every filter, the sharpened kinds with a sharpness of 1.
    pub const ALL: [Self; 7] = [
        Self::Nearest,
        Self::Hardware,
        Self::Box,
        Self::Bilinear { sharpness: 1.0 },
        Self::TentNarrow { sharpness: 1.0 },
        Self::TentMedium { sharpness: 1.0 },
        Self::TentWide { sharpness: 1.0 },
    ];

    /// Greatest distance per axis, in texels, from the place looked up to the centre of a texel that counts.
    pub const fn reach_texels(self) -> f64 {
        match self {
            Self::Nearest => 0.5,
            Self::Hardware | Self::Bilinear { .. } => 1.0,
            Self::Box => 1.5,
            Self::TentNarrow { .. } => 2.0,
            Self::TentMedium { .. } => 3.0,
            Self::TentWide { .. } => 4.0,
        }
    }

    /// Edge sharpness; 1 for the filters that have none.
    pub const fn sharpness(self) -> f32 {
        match self {
            Self::Bilinear { sharpness }
            | Self::TentNarrow { sharpness }
            | Self::TentMedium { sharpness }
            | Self::TentWide { sharpness } => sharpness,
            Self::Nearest | Self::Hardware | Self::Box => 1.0,
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
            Self::TentNarrow { .. } => 4,
            Self::Box | Self::TentMedium { .. } => 9,
            Self::TentWide { .. } => 16,
        }
    }

    /// Name of the WGSL module, and what its function takes besides map and receiver.
    pub(crate) const fn wgsl(self) -> (&'static str, FilterSampler) {
        match self {
            Self::Nearest => ("filter_nearest", FilterSampler::None),
            Self::Hardware => ("filter_hardware", FilterSampler::Comparison),
            Self::Box => ("filter_box", FilterSampler::None),
            Self::Bilinear { .. } => ("filter_bilinear", FilterSampler::Point),
            Self::TentNarrow { .. } => ("filter_tent_narrow", FilterSampler::Point),
            Self::TentMedium { .. } => ("filter_tent_medium", FilterSampler::Point),
            Self::TentWide { .. } => ("filter_tent_wide", FilterSampler::Point),
        }
    }
}

/// The sampler that a filter's function takes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum FilterSampler {
    None,
    Comparison,
    Point,
}
