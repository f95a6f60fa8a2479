//! Defines how a depth map stores its depths.

/// Selects the format of a depth map. All depths are reversed: near 1, far 0.
///
/// The pipelines of casters must be made for the format
/// ([`CasterPipelineDescriptor::depth_formats`](crate::caster::CasterPipelineDescriptor::depth_formats));
/// a light whose format a caster lacks returns
/// [`ShadowError::CasterFormat`](crate::ShadowError::CasterFormat) when it is recorded.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum DepthFormat {
    /// Stores 32-bit floats, 4 bytes a texel, with an error of a few ulps at any range. This is the
    /// default.
    #[default]
    Float32,
    /// Stores 16-bit steps, 2 bytes a texel, for directional lights alone. A step is 1/65535 of the
    /// depth range (100 m: 1.5 mm, 1 km: 15 mm). The bias grows by one step, and the gap that it
    /// can leave by two
    /// ([`ViewReport::max_peter_panning_world`](crate::report::ViewReport::max_peter_panning_world)).
    /// The step is invisible while it is below a quarter of a texel, at ranges under some 16 000
    /// texel sizes; beyond that, shadows first go missing at contacts.
    ///
    /// Local lights keep 32 bits: the step of a perspective depth grows with the square of the
    /// distance, to metres at the far end of a lamp's reach.
    Unorm16,
}

impl DepthFormat {
    /// Lists all formats, in the order of [`DepthFormat::index`].
    pub(crate) const ALL: [Self; 2] = [Self::Float32, Self::Unorm16];

    /// Returns the format of the texture.
    pub const fn texture_format(self) -> wgpu::TextureFormat {
        match self {
            Self::Float32 => wgpu::TextureFormat::Depth32Float,
            Self::Unorm16 => wgpu::TextureFormat::Depth16Unorm,
        }
    }

    /// Returns the device memory of a texel in bytes.
    pub(crate) const fn bytes_per_texel(self) -> u64 {
        match self {
            Self::Float32 => 4,
            Self::Unorm16 => 2,
        }
    }

    /// Returns how far storing a depth may move it, in ndc, beyond the ulps of f32: a whole step,
    /// since drivers need not round to the nearest.
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
