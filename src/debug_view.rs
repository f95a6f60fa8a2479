//! `DebugView`: a depth map as a picture for people.

use bytemuck::{Pod, Zeroable};
use wgpu::util::DeviceExt;

use crate::error::DebugViewError;
use crate::receive::ShadowSource;
use crate::shader;

/// Mirror of `ShadowDebugView` in `wgsl/pass/debug_view.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
struct DebugUniform {
    layer: u32,
    map_size: f32,
}

/// Draws any layer of a map as grey levels: dark near the light, white at the far plane and where nothing casts.
#[derive(Debug)]
pub struct DebugView {
    pipeline: wgpu::RenderPipeline,
    layout: wgpu::BindGroupLayout,
}

impl DebugView {
    /// For passes with one colour target of `format`, no depth attachment and one sample.
    ///
    /// # Errors
    /// [`DebugViewError::Format`] for a format that floats cannot be drawn to.
    pub fn new(device: &wgpu::Device, format: wgpu::TextureFormat) -> Result<Self, DebugViewError> {
        let floats = matches!(
            format.sample_type(None, Some(device.features())),
            Some(wgpu::TextureSampleType::Float { .. })
        );
        let renderable = format
            .guaranteed_format_features(device.features())
            .allowed_usages
            .contains(wgpu::TextureUsages::RENDER_ATTACHMENT);
        if !(floats && renderable) {
            return Err(DebugViewError::Format { format });
        }
        let layout = device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: Some("shadow debug view"),
            entries: &[
                wgpu::BindGroupLayoutEntry {
                    binding: 0,
                    visibility: wgpu::ShaderStages::FRAGMENT,
                    ty: wgpu::BindingType::Buffer {
                        ty: wgpu::BufferBindingType::Uniform,
                        has_dynamic_offset: false,
                        min_binding_size: wgpu::BufferSize::new(size_of::<DebugUniform>() as u64),
                    },
                    count: None,
                },
                wgpu::BindGroupLayoutEntry {
                    binding: 1,
                    visibility: wgpu::ShaderStages::FRAGMENT,
                    ty: wgpu::BindingType::Texture {
                        sample_type: wgpu::TextureSampleType::Depth,
                        view_dimension: wgpu::TextureViewDimension::D2Array,
                        multisampled: false,
                    },
                    count: None,
                },
            ],
        });
        let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
            label: Some("shadow debug view"),
            source: wgpu::ShaderSource::Wgsl(shader::DEBUG_VIEW.source.into()),
        });
        let pipeline_layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: Some("shadow debug view"),
            bind_group_layouts: &[Some(&layout)],
            immediate_size: 0,
        });
        let pipeline = device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: Some("shadow debug view"),
            layout: Some(&pipeline_layout),
            vertex: wgpu::VertexState {
                module: &module,
                entry_point: Some("shadow_debug_vertex"),
                compilation_options: Default::default(),
                buffers: &[],
            },
            primitive: wgpu::PrimitiveState::default(),
            depth_stencil: None,
            multisample: wgpu::MultisampleState::default(),
            fragment: Some(wgpu::FragmentState {
                module: &module,
                entry_point: Some("shadow_debug_fragment"),
                compilation_options: Default::default(),
                targets: &[Some(format.into())],
            }),
            multiview_mask: None,
            cache: None,
        });
        Ok(Self { pipeline, layout })
    }

    /// Draws layer `layer` of `source` over the whole viewport of `pass`, which the engine may set to a corner of its window.
    /// Sets pipeline and bind group 0.
    ///
    /// # Errors
    /// [`DebugViewError::Layer`] for a layer that the map does not have; nothing is drawn then.
    pub fn draw(
        &self,
        device: &wgpu::Device,
        pass: &mut wgpu::RenderPass<'_>,
        source: ShadowSource<'_>,
        layer: u32,
    ) -> Result<(), DebugViewError> {
        let receiver = source.receiver;
        let layers = receiver.view_count;
        if layer >= layers {
            return Err(DebugViewError::Layer { layer, layers });
        }
        let uniform = DebugUniform {
            layer,
            map_size: receiver.map.texture().width() as f32,
        };
        let buffer = device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
            label: Some("shadow debug view"),
            contents: bytemuck::bytes_of(&uniform),
            usage: wgpu::BufferUsages::UNIFORM,
        });
        let bind_group = device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("shadow debug view"),
            layout: &self.layout,
            entries: &[
                wgpu::BindGroupEntry {
                    binding: 0,
                    resource: buffer.as_entire_binding(),
                },
                wgpu::BindGroupEntry {
                    binding: 1,
                    resource: wgpu::BindingResource::TextureView(receiver.map),
                },
            ],
        });
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(0, &bind_group, &[]);
        pass.draw(0..3, 0..1);
        Ok(())
    }
}
