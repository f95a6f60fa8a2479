//! Tints the engine's image by the view that covers each pixel.

use bytemuck::{Pod, Zeroable};
use glam::Mat4;

use crate::error::DeviceRefusal;
use crate::gpu::{FullscreenTarget, capture_device_errors, filled_buffer, fullscreen_pipeline};
use crate::receive::{SampledMaps, ShadowViewUniform};
use crate::shader;

/// Mirrors `ShadowTint` in `wgsl/pass/cascade_tint.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
struct TintUniform {
    render_from_clip: [[f32; 4]; 4],
    count: [u32; 4],
}

/// Holds the pipeline that multiplies an image by its tint.
#[derive(Debug)]
pub(crate) struct CascadeTint {
    pipeline: wgpu::RenderPipeline,
    layout: wgpu::BindGroupLayout,
    sampler: wgpu::Sampler,
}

impl CascadeTint {
    /// Is the largest number of views of one light that a tint distinguishes.
    pub(super) const VIEWS: usize = 8;

    /// Creates the pipeline for targets of `format`. The caller captures the errors of the device.
    pub(super) fn new(device: &wgpu::Device, format: wgpu::TextureFormat) -> Self {
        let layout = create_layout(device);
        Self {
            pipeline: create_pipeline(device, &layout, format),
            layout,
            sampler: device.create_sampler(&wgpu::SamplerDescriptor {
                label: Some("shadow cascade tint"),
                ..Default::default()
            }),
        }
    }

    /// Records the draw. If it returns an error, nothing has been recorded.
    pub(super) fn draw(
        &self,
        device: &wgpu::Device,
        pass: &mut wgpu::RenderPass<'_>,
        maps: &SampledMaps<'_>,
        depth: &wgpu::TextureView,
        render_from_clip: Mat4,
    ) -> Result<(), DeviceRefusal> {
        let mut views = [ShadowViewUniform::zeroed(); Self::VIEWS];
        let count = maps.uniforms.len().min(Self::VIEWS);
        views[..count].copy_from_slice(&maps.uniforms[..count]);
        let header = TintUniform {
            render_from_clip: render_from_clip.to_cols_array_2d(),
            count: [count as u32, 0, 0, 0],
        };
        let upload = |contents: &[u8]| {
            let usage = wgpu::BufferUsages::UNIFORM;
            filled_buffer(device, "shadow cascade tint", contents, usage)
        };
        let header = upload(bytemuck::bytes_of(&header))?;
        let views = upload(bytemuck::cast_slice(&views))?;
        let bind_group = capture_device_errors(device, || {
            device.create_bind_group(&wgpu::BindGroupDescriptor {
                label: Some("shadow cascade tint"),
                layout: &self.layout,
                entries: &[
                    wgpu::BindGroupEntry {
                        binding: 0,
                        resource: header.as_entire_binding(),
                    },
                    wgpu::BindGroupEntry {
                        binding: 1,
                        resource: views.as_entire_binding(),
                    },
                    wgpu::BindGroupEntry {
                        binding: 2,
                        resource: wgpu::BindingResource::TextureView(depth),
                    },
                    wgpu::BindGroupEntry {
                        binding: 3,
                        resource: wgpu::BindingResource::Sampler(&self.sampler),
                    },
                ],
            })
        })?;
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(0, &bind_group, &[]);
        pass.draw(0..3, 0..1);
        Ok(())
    }
}

fn create_layout(device: &wgpu::Device) -> wgpu::BindGroupLayout {
    let entry = |binding, ty| wgpu::BindGroupLayoutEntry {
        binding,
        visibility: wgpu::ShaderStages::FRAGMENT,
        ty,
        count: None,
    };
    let uniform = |bytes: usize| wgpu::BindingType::Buffer {
        ty: wgpu::BufferBindingType::Uniform,
        has_dynamic_offset: false,
        min_binding_size: wgpu::BufferSize::new(bytes as u64),
    };
    let depth = wgpu::BindingType::Texture {
        sample_type: wgpu::TextureSampleType::Float { filterable: false },
        view_dimension: wgpu::TextureViewDimension::D2,
        multisampled: false,
    };
    device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: Some("shadow cascade tint"),
        entries: &[
            entry(0, uniform(size_of::<TintUniform>())),
            entry(
                1,
                uniform(CascadeTint::VIEWS * size_of::<ShadowViewUniform>()),
            ),
            entry(2, depth),
            entry(
                3,
                wgpu::BindingType::Sampler(wgpu::SamplerBindingType::NonFiltering),
            ),
        ],
    })
}

fn create_pipeline(
    device: &wgpu::Device,
    layout: &wgpu::BindGroupLayout,
    format: wgpu::TextureFormat,
) -> wgpu::RenderPipeline {
    let source = shader::compose(&[shader::CASCADE_TINT.name]).unwrap_or_default();
    let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: Some("shadow cascade tint"),
        source: wgpu::ShaderSource::Wgsl(source.into()),
    });
    let multiply = wgpu::BlendComponent {
        src_factor: wgpu::BlendFactor::Dst,
        dst_factor: wgpu::BlendFactor::Zero,
        operation: wgpu::BlendOperation::Add,
    };
    let target = wgpu::ColorTargetState {
        format,
        blend: Some(wgpu::BlendState {
            color: multiply,
            alpha: multiply,
        }),
        write_mask: wgpu::ColorWrites::ALL,
    };
    fullscreen_pipeline(
        device,
        "shadow cascade tint",
        Some(layout),
        &module,
        Some("shadow_tint_fragment"),
        FullscreenTarget::Color(target),
    )
}
