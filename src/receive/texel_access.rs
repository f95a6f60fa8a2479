//! Determines how the filters that compare each texel read the texels: by gathers, or by samples
//! where a device has no gather.

use crate::error::DeviceRefusal;
use crate::gpu::{FullscreenTarget, capture_device_errors, fullscreen_pipeline};
use crate::shader;

/// Tells how shaders read single texels of a map.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum TexelAccess {
    /// Gathers from a depth texture with constant offsets, by `wgsl/texels_by_offsets.wgsl`.
    OffsetGathers,
    /// Gathers from a depth texture, by `wgsl/texels.wgsl`.
    Gathers,
    /// Samples a texture of unfilterable floats, by `wgsl/texels_by_samples.wgsl`.
    Samples,
}

impl TexelAccess {
    /// Returns what shaders of `device` can do. All backends can gather with offsets except OpenGL,
    /// for which naga writes no such gather of a depth texture, and where GLSL ES 3.00 has no
    /// gather at all. There a pipeline that gathers is created as a test, so that nothing depends
    /// on names and versions.
    pub(super) fn of(device: &wgpu::Device) -> Self {
        if device.adapter_info().backend != wgpu::Backend::Gl {
            return Self::OffsetGathers;
        }
        match capture_device_errors(device, || gathering_pipeline(device)) {
            Err(DeviceRefusal::Refused(_)) => Self::Samples,
            // A device that is lost or out of memory returns that error again when the bind group
            // is created.
            Ok(_) | Err(_) => Self::Gathers,
        }
    }

    /// Returns the module that this access needs instead of the default one.
    pub(super) const fn module(self) -> Option<&'static str> {
        match self {
            Self::OffsetGathers => Some("texels_by_offsets"),
            Self::Gathers => None,
            Self::Samples => Some("texels_by_samples"),
        }
    }

    /// Returns the map's type in WGSL, which is the module's alias `ShadowMap`.
    pub(super) const fn map_wgsl(self) -> &'static str {
        match self {
            Self::OffsetGathers | Self::Gathers => "texture_depth_2d_array",
            Self::Samples => "texture_2d_array<f32>",
        }
    }

    /// Returns the map's type in a bind group layout.
    pub(super) const fn map_binding(self) -> wgpu::BindingType {
        let sample_type = match self {
            Self::OffsetGathers | Self::Gathers => wgpu::TextureSampleType::Depth,
            Self::Samples => wgpu::TextureSampleType::Float { filterable: false },
        };
        wgpu::BindingType::Texture {
            sample_type,
            view_dimension: wgpu::TextureViewDimension::D2Array,
            multisampled: false,
        }
    }
}

/// Creates a pipeline whose fragment shader gathers from a depth texture.
fn gathering_pipeline(device: &wgpu::Device) -> wgpu::RenderPipeline {
    const LABEL: &str = "shadow gather probe";
    let entry = |binding, ty| wgpu::BindGroupLayoutEntry {
        binding,
        visibility: wgpu::ShaderStages::FRAGMENT,
        ty,
        count: None,
    };
    let sampler = wgpu::BindingType::Sampler(wgpu::SamplerBindingType::NonFiltering);
    let layout = device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: Some(LABEL),
        entries: &[
            entry(0, TexelAccess::Gathers.map_binding()),
            entry(1, sampler),
        ],
    });
    let source = shader::compose(&[shader::GATHER_PROBE.name]).unwrap_or_default();
    let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: Some(LABEL),
        source: wgpu::ShaderSource::Wgsl(source.into()),
    });
    fullscreen_pipeline(
        device,
        LABEL,
        Some(&layout),
        &module,
        Some("shadow_probe_fragment"),
        FullscreenTarget::Color(wgpu::TextureFormat::Rgba8Unorm.into()),
    )
}
