//! Makes the pipeline that clears a rectangle of a layer.

use crate::ShadowError;
use crate::error::DeviceError;
use crate::gpu::{DepthFormat, capture_device_errors};
use crate::shader;

/// Makes the pipeline whose draw of three vertices sets the depths within the scissor rectangle of
/// a depth pass to the far plane. It needs no bind group.
pub(crate) fn rect_clear_pipeline(
    device: &wgpu::Device,
    label: &str,
    format: DepthFormat,
) -> Result<wgpu::RenderPipeline, ShadowError> {
    let label = format!("{label} clearing of a rectangle");
    let create = || {
        let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
            label: Some(&label),
            source: wgpu::ShaderSource::Wgsl(shader::FULLSCREEN.source.into()),
        });
        let layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: Some(&label),
            bind_group_layouts: &[],
            immediate_size: 0,
        });
        device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: Some(&label),
            layout: Some(&layout),
            vertex: wgpu::VertexState {
                module: &module,
                entry_point: Some("shadow_fullscreen_vertex"),
                compilation_options: Default::default(),
                buffers: &[],
            },
            primitive: wgpu::PrimitiveState::default(),
            depth_stencil: Some(wgpu::DepthStencilState {
                format: format.texture_format(),
                depth_write_enabled: Some(true),
                depth_compare: Some(wgpu::CompareFunction::Always),
                stencil: wgpu::StencilState::default(),
                bias: wgpu::DepthBiasState::default(),
            }),
            multisample: wgpu::MultisampleState::default(),
            fragment: None,
            multiview_mask: None,
            cache: None,
        })
    };
    capture_device_errors(device, create).map_err(|refusal| {
        ShadowError::Device(DeviceError {
            object: "the pipeline that clears a rectangle",
            refusal,
        })
    })
}
