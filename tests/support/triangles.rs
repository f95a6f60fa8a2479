//! Draws images of triangles through any camera and any fragment stage.

use glam::Vec3;
use image::RgbaImage;
use wgpu_shadows::ShadowBindings;

use crate::support::gpu::Gpu;
use crate::support::picture::{COLOR, color_target, depth_target, scene_pass};
use crate::support::readback;

/// Is the number of pixels per side.
pub const SIZE: u32 = 128;

/// Precedes a fragment stage: the uniform `eye` and the type of its argument.
pub const VERTEX: &str = "
struct Eye {
    clip_from_render: mat4x4<f32>,
    // Is the direction toward an orthographic camera, with w = 0, or the position of a perspective one, with w = 1.
    place: vec4<f32>,
}
@group(0) @binding(0) var<uniform> eye: Eye;

struct Varying {
    @builtin(position) clip: vec4<f32>,
    @location(0) position: vec3<f32>,
}

@vertex
fn vertex(@location(0) position: vec3<f32>) -> Varying {
    return Varying(eye.clip_from_render * vec4<f32>(position, 1.0), position);
}
";

/// Draws an image of triangles, with the lights in group 1 if there are any.
pub fn draw(
    gpu: &Gpu,
    source: &str,
    uniform: &[f32],
    vertices: &[Vec3],
    bindings: Option<&ShadowBindings>,
) -> RgbaImage {
    let device = &gpu.device;
    let layout = device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: Some("eye"),
        entries: &[wgpu::BindGroupLayoutEntry {
            binding: 0,
            visibility: wgpu::ShaderStages::VERTEX_FRAGMENT,
            ty: wgpu::BindingType::Buffer {
                ty: wgpu::BufferBindingType::Uniform,
                has_dynamic_offset: false,
                min_binding_size: None,
            },
            count: None,
        }],
    });
    let group = device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: Some("eye"),
        layout: &layout,
        entries: &[wgpu::BindGroupEntry {
            binding: 0,
            resource: gpu
                .buffer(uniform, wgpu::BufferUsages::UNIFORM)
                .as_entire_binding(),
        }],
    });
    let mut layouts = vec![Some(&layout)];
    layouts.extend(bindings.map(|bindings| Some(bindings.layout())));
    let pipeline_layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
        label: Some("triangles"),
        bind_group_layouts: &layouts,
        immediate_size: 0,
    });
    let module = gpu.shader(source);
    let pipeline = device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some("triangles"),
        layout: Some(&pipeline_layout),
        vertex: wgpu::VertexState {
            module: &module,
            entry_point: Some("vertex"),
            compilation_options: Default::default(),
            buffers: &[Some(wgpu::VertexBufferLayout {
                array_stride: 12,
                step_mode: wgpu::VertexStepMode::Vertex,
                attributes: &wgpu::vertex_attr_array![0 => Float32x3],
            })],
        },
        primitive: wgpu::PrimitiveState::default(),
        depth_stencil: Some(wgpu::DepthStencilState {
            format: wgpu::TextureFormat::Depth32Float,
            depth_write_enabled: Some(true),
            depth_compare: Some(wgpu::CompareFunction::Less),
            stencil: wgpu::StencilState::default(),
            bias: wgpu::DepthBiasState::default(),
        }),
        multisample: wgpu::MultisampleState::default(),
        fragment: Some(wgpu::FragmentState {
            module: &module,
            entry_point: Some("fragment"),
            compilation_options: Default::default(),
            targets: &[Some(COLOR.into())],
        }),
        multiview_mask: None,
        cache: None,
    });
    let (target, depth) = (color_target(gpu, SIZE), depth_target(gpu, SIZE));
    let vertex_buffer = gpu.buffer(vertices, wgpu::BufferUsages::VERTEX);
    let mut encoder = gpu.encoder();
    {
        let mut pass = scene_pass(&mut encoder, &target, &depth);
        pass.set_pipeline(&pipeline);
        pass.set_bind_group(0, &group, &[]);
        if let Some(bindings) = bindings {
            pass.set_bind_group(bindings.group(), bindings.bind_group(), &[]);
        }
        pass.set_vertex_buffer(0, vertex_buffer.slice(..));
        pass.draw(0..vertices.len() as u32, 0..1);
    }
    gpu.submit(encoder);
    readback::rgba8(gpu, &target)
}
