//! Holds vertex buffers in world space, and draws them in depth passes.

use std::ops::Range;

use glam::{DMat4, DVec3, Mat4, Vec3, Vec4};

use crate::bind;
use crate::gpu::Gpu;
use crate::mesh::Mesh;
use crate::scene::Scene;

pub const DEPTH_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Depth32Float;

/// Holds the meshes of a scene, at their absolute coordinates as f32 represents them.
pub struct WorldMeshes {
    meshes: Vec<DrawnMesh>,
}

struct DrawnMesh {
    vertices: wgpu::Buffer,
    indices: wgpu::Buffer,
    indices_drawn: Range<u32>,
    base_vertex: i32,
}

/// Mirrors `View` in the shaders.
#[repr(C)]
#[derive(Clone, Copy, bytemuck::Pod, bytemuck::Zeroable)]
pub struct ViewUniform {
    pub clip_from_world: Mat4,
    /// Is the position of a local light, with its far distance in w.
    pub light: Vec4,
    /// Is the position of the camera, or the unit direction toward a sun.
    pub viewer_or_sun: Vec4,
}

impl ViewUniform {
    pub fn new(clip_from_world: DMat4, light: Vec4, viewer_or_sun: Vec4) -> Self {
        Self {
            clip_from_world: clip_from_world.as_mat4(),
            light,
            viewer_or_sun,
        }
    }
}

impl WorldMeshes {
    pub fn new(gpu: &Gpu, scene: &Scene) -> Self {
        Self::of_meshes(gpu, &scene.meshes, scene.origin)
    }

    /// Makes the meshes of a render space that begins at `origin`.
    pub fn of_meshes(gpu: &Gpu, meshes: &[Mesh], origin: DVec3) -> Self {
        let meshes = meshes.iter().map(|mesh| {
            let positions: Vec<Vec3> = mesh
                .positions
                .iter()
                .map(|position| (position.as_dvec3() + origin).as_vec3())
                .collect();
            DrawnMesh {
                vertices: gpu.buffer(&positions, wgpu::BufferUsages::VERTEX),
                indices: gpu.buffer(&mesh.indices, wgpu::BufferUsages::INDEX),
                indices_drawn: 0..mesh.indices.len() as u32,
                base_vertex: 0,
            }
        });
        Self {
            meshes: meshes.collect(),
        }
    }

    /// Makes the same meshes in one pair of buffers, with one draw each.
    pub fn in_shared_buffers(gpu: &Gpu, meshes: &[Mesh]) -> Self {
        let positions: Vec<Vec3> = meshes.iter().flat_map(|m| &m.positions).copied().collect();
        let corners: Vec<u32> = meshes.iter().flat_map(|m| &m.indices).copied().collect();
        let vertices = gpu.buffer(&positions, wgpu::BufferUsages::VERTEX);
        let indices = gpu.buffer(&corners, wgpu::BufferUsages::INDEX);
        let (mut base_vertex, mut first_index) = (0, 0);
        let meshes = meshes.iter().map(|mesh| {
            let end = first_index + mesh.indices.len() as u32;
            let drawn = DrawnMesh {
                vertices: vertices.clone(),
                indices: indices.clone(),
                indices_drawn: first_index..end,
                base_vertex,
            };
            base_vertex += mesh.positions.len() as i32;
            first_index = end;
            drawn
        });
        Self {
            meshes: meshes.collect(),
        }
    }

    pub fn count(&self) -> u32 {
        self.meshes.len() as u32
    }

    /// Records a pass that clears `target` to the far plane and draws everything.
    pub fn draw(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        pipeline: &wgpu::RenderPipeline,
        view: &wgpu::BindGroup,
        target: &wgpu::TextureView,
    ) {
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("textbook depth"),
            depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                view: target,
                depth_ops: Some(wgpu::Operations {
                    load: wgpu::LoadOp::Clear(1.0),
                    store: wgpu::StoreOp::Store,
                }),
                stencil_ops: None,
            }),
            ..Default::default()
        });
        pass.set_pipeline(pipeline);
        pass.set_bind_group(0, view, &[]);
        for mesh in &self.meshes {
            pass.set_vertex_buffer(0, mesh.vertices.slice(..));
            pass.set_index_buffer(mesh.indices.slice(..), wgpu::IndexFormat::Uint32);
            pass.draw_indexed(mesh.indices_drawn.clone(), mesh.base_vertex, 0..1);
        }
    }
}

/// Creates the depth pipeline of `source`, with a fragment stage where one is named, and the layout
/// of its only group.
pub fn depth_pipeline(
    gpu: &Gpu,
    source: &str,
    fragment_entry: Option<&str>,
) -> (wgpu::RenderPipeline, wgpu::BindGroupLayout) {
    let module = gpu.shader(source);
    let view_layout = bind::layout(gpu, wgpu::ShaderStages::VERTEX_FRAGMENT, &[bind::UNIFORM]);
    let layout = gpu
        .device
        .create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: Some("textbook depth"),
            bind_group_layouts: &[Some(&view_layout)],
            immediate_size: 0,
        });
    let position = wgpu::vertex_attr_array![0 => Float32x3];
    let pipeline = gpu
        .device
        .create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: Some("textbook depth"),
            layout: Some(&layout),
            vertex: wgpu::VertexState {
                module: &module,
                entry_point: Some("vertex"),
                compilation_options: Default::default(),
                buffers: &[Some(wgpu::VertexBufferLayout {
                    array_stride: 12,
                    step_mode: wgpu::VertexStepMode::Vertex,
                    attributes: &position,
                })],
            },
            primitive: wgpu::PrimitiveState::default(),
            depth_stencil: Some(wgpu::DepthStencilState {
                format: DEPTH_FORMAT,
                depth_write_enabled: Some(true),
                depth_compare: Some(wgpu::CompareFunction::Less),
                stencil: Default::default(),
                bias: Default::default(),
            }),
            multisample: Default::default(),
            fragment: fragment_entry.map(|entry| wgpu::FragmentState {
                module: &module,
                entry_point: Some(entry),
                compilation_options: Default::default(),
                targets: &[],
            }),
            multiview_mask: None,
            cache: None,
        });
    (pipeline, view_layout)
}

/// Creates the map, its sampler as the tutorial has it (nearest), and the binding types of both.
pub fn map_with_sampler(gpu: &Gpu, map_size: u32, layers: u32) -> (wgpu::Texture, wgpu::Sampler) {
    let texture = gpu.device.create_texture(&wgpu::TextureDescriptor {
        label: Some("textbook map"),
        size: wgpu::Extent3d {
            width: map_size,
            height: map_size,
            depth_or_array_layers: layers,
        },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: DEPTH_FORMAT,
        usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::TEXTURE_BINDING,
        view_formats: &[],
    });
    let sampler = gpu
        .device
        .create_sampler(&wgpu::SamplerDescriptor::default());
    (texture, sampler)
}

/// Returns the binding types of a uniform, of a map of this dimension and of its sampler.
pub fn lookup_types(view_dimension: wgpu::TextureViewDimension) -> [wgpu::BindingType; 3] {
    [
        bind::UNIFORM,
        bind::depth_texture(view_dimension),
        wgpu::BindingType::Sampler(wgpu::SamplerBindingType::NonFiltering),
    ]
}
