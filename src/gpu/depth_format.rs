//! How a depth map stores its depths.

/// Format of a depth map. All depths are reversed: near 1, far 0.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum DepthFormat {
    /// 32-bit floats, 4 bytes a texel: an error of a few ulps, at any range.
    #[default]
    Float32,
    /// 16-bit steps, 2 bytes a texel, for directional lights alone. A step is 1/65535 of the depth range (100 m: 1.5 mm,
    /// 1 km: 15 mm) and adds so much to the bias, and twice that to the gap that it can leave
    /// ([`ViewReport::worst_gap_world`](crate::ViewReport::worst_gap_world)). It goes unseen while it is below a quarter of a
    /// texel, at ranges under some 16 000 texel sizes; beyond, contacts lose their shadow first.
    ///
    /// Local lights keep 32 bits: the step of a perspective depth grows with the square of the distance, to metres at the
    /// far end of a lamp's reach.
    Unorm16,
}

impl DepthFormat {
    /// All formats, in the order of [`DepthFormat::index`].
    pub(crate) const ALL: [Self; 2] = [Self::Float32, Self::Unorm16];

    /// The format of the texture.
    pub const fn texture_format(self) -> wgpu::TextureFormat {
        match self {
            Self::Float32 => wgpu::TextureFormat::Depth32Float,
            Self::Unorm16 => wgpu::TextureFormat::Depth16Unorm,
        }
    }

    /// Device memory of a texel.
    pub(crate) const fn bytes_per_texel(self) -> u64 {
        match self {
            Self::Float32 => 4,
            Self::Unorm16 => 2,
        }
    }

    /// What storing a depth may move it by, in ndc, beyond the ulps of f32: a whole step, since drivers need not round to the
    /// nearest.
    pub(crate) const fn step_ndc(self) -> f64 {
        match self {
            Self::Float32 => 0.0,
            Self::Unorm16 => 1.0 / 65_535.0,
        }
    }

    pub(crate) const fn index(self) -> usize {
        self as usize
    }
}
