//! How the filters that compare each texel come by the texels: by gathers, or where a device has none by samples.

use crate::error::DeviceRefusal;
use crate::gpu::{capture_device_errors, fullscreen_pipeline};
use crate::shader;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum TexelAccess {
    /// `wgsl/texels.wgsl`: the map is a depth texture.
    Gathers,
    /// `wgsl/texels_by_samples.wgsl`: the map is a texture of unfilterable floats.
    Samples,
}

impl TexelAccess {
    /// What shaders of `device` can do. All backends gather but OpenGL's, where GLSL ES 3.00 has no gather; there a pipeline
    /// that does is tried, so that nothing is guessed from names and versions.
    pub fn of(device: &wgpu::Device) -> Self {
        if device.adapter_info().backend != wgpu::Backend::Gl {
            return Self::Gathers;
        }
        match capture_device_errors(device, || gathering_pipeline(device)) {
            Err(DeviceRefusal::Refused(_)) => Self::Samples,
            // A device that is lost or out of memory says so again where it is asked for what is wanted.
            Ok(_) | Err(_) => Self::Gathers,
        }
    }

    /// The module that takes the place of another for this access.
    pub const fn module(self) -> Option<&'static str> {
        match self {
            Self::Gathers => None,
            Self::Samples => Some("texels_by_samples"),
        }
    }

    /// The map's type in WGSL, as `ShadowMap` of the module.
    pub const fn map_wgsl(self) -> &'static str {
        match self {
            Self::Gathers => "texture_depth_2d_array",
            Self::Samples => "texture_2d_array<f32>",
        }
    }

    /// The same in a layout.
    pub const fn map_binding(self) -> wgpu::BindingType {
        let sample_type = match self {
            Self::Gathers => wgpu::TextureSampleType::Depth,
            Self::Samples => wgpu::TextureSampleType::Float { filterable: false },
        };
        wgpu::BindingType::Texture {
            sample_type,
            view_dimension: wgpu::TextureViewDimension::D2Array,
            multisampled: false,
        }
    }
}

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
    let target = wgpu::TextureFormat::Rgba8Unorm.into();
    fullscreen_pipeline(
        device,
        LABEL,
        &layout,
        &module,
        "shadow_probe_fragment",
        target,
    )
}
