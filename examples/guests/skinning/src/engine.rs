//! Is the engine: it holds the characters on the device, poses them, and draws with one forward
//! pass.

use bytemuck::{Pod, Zeroable};
use example_support::camera::Camera;
use example_support::mesh::{Instance, Vertex};
use glam::{Mat4, Vec3, Vec4};
use shadow_support::gpu::Gpu;
use wgpu::TextureFormat::{Depth32Float, Rgba8Unorm, Rgba8UnormSrgb};
use wgpu::{BufferUsages, ShaderStages, TextureUsages};

use crate::character::{Character, MAX_JOINTS, Pose, SkinVertex};
use crate::scene::{Lights, Scene, TOWARD_SUN};
use crate::shadows::Shadows;
use wgpu_shadows::ShadowBindings;

/// Is WGSL that poses the vertices of an actor, for any vertex stage.
pub const SKIN_WGSL: &str = include_str!("skin.wgsl");

/// Is the layout of the vertices of an actor.
pub const SKIN_BUFFERS: wgpu::VertexBufferLayout<'static> = wgpu::VertexBufferLayout {
    array_stride: size_of::<SkinVertex>() as u64,
    step_mode: wgpu::VertexStepMode::Vertex,
    attributes: &wgpu::vertex_attr_array![
        0 => Float32x3, 1 => Float32x3, 2 => Float32x3, 3 => Uint8x4, 4 => Float32x4
    ],
};

/// Mirrors `Pose` in `skin.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
struct PoseUniform {
    render_from_bind: [Mat4; MAX_JOINTS],
    morph_weight: f32,
    albedo: Vec3,
}

/// Mirrors `Frame` in `forward.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
struct FrameUniform {
    clip_from_render: Mat4,
    eye: Vec4,
    toward_sun: Vec4,
    lamp: Vec4,
}

/// Is a character on the device.
pub struct Actor {
    pub id: u64,
    pub pose: Pose,
    /// Counts the poses that differed from the one before.
    pub pose_version: u64,
    pub vertices: wgpu::Buffer,
    pub indices: wgpu::Buffer,
    pub index_count: u32,
    /// Binds the pose.
    pub group: wgpu::BindGroup,
    uniform: wgpu::Buffer,
    albedo: Vec3,
}

impl Actor {
    pub fn new(
        gpu: &Gpu,
        layout: &wgpu::BindGroupLayout,
        character: &Character,
        (id, pose): (u64, Pose),
    ) -> Self {
        let uniform = gpu.device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("pose"),
            size: size_of::<PoseUniform>() as u64,
            usage: BufferUsages::UNIFORM | BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        let actor = Self {
            id,
            pose,
            pose_version: 0,
            vertices: gpu.buffer(&character.vertices, BufferUsages::VERTEX),
            indices: gpu.buffer(&character.indices, BufferUsages::INDEX),
            index_count: character.indices.len() as u32,
            group: group(gpu, layout, &uniform),
            uniform,
            albedo: Vec3::new(0.75, 0.3 + 0.2 * id as f32, 0.35),
        };
        actor.upload(gpu);
        actor
    }

    /// Sets the pose, and its version if the pose is another.
    pub fn set_pose(&mut self, gpu: &Gpu, pose: Pose) {
        if pose != self.pose {
            self.pose = pose;
            self.pose_version += 1;
            self.upload(gpu);
        }
    }

    fn upload(&self, gpu: &Gpu) {
        let uniform = PoseUniform {
            render_from_bind: self.pose.render_from_bind,
            morph_weight: self.pose.morph_weight,
            albedo: self.albedo,
        };
        gpu.queue
            .write_buffer(&self.uniform, 0, bytemuck::bytes_of(&uniform));
    }
}

/// Returns the layout of a bind group of one uniform buffer.
pub fn uniform_layout(gpu: &Gpu) -> wgpu::BindGroupLayout {
    let descriptor = wgpu::BindGroupLayoutDescriptor {
        label: Some("uniform"),
        entries: &[wgpu::BindGroupLayoutEntry {
            binding: 0,
            visibility: ShaderStages::VERTEX_FRAGMENT,
            ty: wgpu::BindingType::Buffer {
                ty: wgpu::BufferBindingType::Uniform,
                has_dynamic_offset: false,
                min_binding_size: None,
            },
            count: None,
        }],
    };
    gpu.device.create_bind_group_layout(&descriptor)
}

fn group(gpu: &Gpu, layout: &wgpu::BindGroupLayout, buffer: &wgpu::Buffer) -> wgpu::BindGroup {
    gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: None,
        layout,
        entries: &[wgpu::BindGroupEntry {
            binding: 0,
            resource: buffer.as_entire_binding(),
        }],
    })
}

/// Draws the scene into an image, and visibilities beside it.
pub struct Renderer {
    pub image: wgpu::Texture,
    /// Holds the visibility of the sun in red and that of the lamp in green.
    pub visibility: wgpu::Texture,
    depths: wgpu::TextureView,
    layout: wgpu::BindGroupLayout,
    skinned: wgpu::RenderPipeline,
    rigid: wgpu::RenderPipeline,
}

impl Renderer {
    pub fn new(
        gpu: &Gpu,
        [width, height]: [u32; 2],
        layout: &wgpu::BindGroupLayout,
        shadows: &ShadowBindings,
    ) -> Self {
        let texture = |format, usage| {
            gpu.device.create_texture(&wgpu::TextureDescriptor {
                label: None,
                size: wgpu::Extent3d {
                    width,
                    height,
                    depth_or_array_layers: 1,
                },
                mip_level_count: 1,
                sample_count: 1,
                dimension: wgpu::TextureDimension::D2,
                format,
                usage: usage | TextureUsages::RENDER_ATTACHMENT,
                view_formats: &[],
            })
        };
        let depths = texture(Depth32Float, TextureUsages::empty());
        let wgsl = [shadows.wgsl(), SKIN_WGSL, include_str!("forward.wgsl")].concat();
        let module = gpu.shader(&wgsl);
        let groups = [Some(layout), Some(layout), Some(shadows.layout())];
        let pipeline_layout = gpu
            .device
            .create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
                label: Some("forward"),
                bind_group_layouts: &groups,
                immediate_size: 0,
            });
        let pipeline = |vertex, buffers: &[Option<wgpu::VertexBufferLayout<'_>>]| {
            gpu.device
                .create_render_pipeline(&wgpu::RenderPipelineDescriptor {
                    label: Some(vertex),
                    layout: Some(&pipeline_layout),
                    vertex: wgpu::VertexState {
                        module: &module,
                        entry_point: Some(vertex),
                        compilation_options: Default::default(),
                        buffers,
                    },
                    fragment: Some(wgpu::FragmentState {
                        module: &module,
                        entry_point: Some("shade"),
                        compilation_options: Default::default(),
                        targets: &[Some(Rgba8UnormSrgb.into()), Some(Rgba8Unorm.into())],
                    }),
                    primitive: wgpu::PrimitiveState {
                        cull_mode: Some(wgpu::Face::Back),
                        ..Default::default()
                    },
                    depth_stencil: Some(wgpu::DepthStencilState {
                        format: Depth32Float,
                        depth_write_enabled: Some(true),
                        depth_compare: Some(wgpu::CompareFunction::Greater),
                        stencil: Default::default(),
                        bias: Default::default(),
                    }),
                    multisample: Default::default(),
                    multiview_mask: None,
                    cache: None,
                })
        };
        let vertex = wgpu::VertexBufferLayout {
            array_stride: size_of::<Vertex>() as u64,
            step_mode: wgpu::VertexStepMode::Vertex,
            attributes: &wgpu::vertex_attr_array![0 => Float32x3, 1 => Float32x3],
        };
        let instance = wgpu::VertexBufferLayout {
            array_stride: size_of::<Instance>() as u64,
            step_mode: wgpu::VertexStepMode::Instance,
            attributes: &wgpu::vertex_attr_array![
                2 => Float32x4, 3 => Float32x4, 4 => Float32x4, 5 => Float32x4, 6 => Float32x3
            ],
        };
        Self {
            skinned: pipeline("skinned_vertex", &[Some(SKIN_BUFFERS)]),
            rigid: pipeline("rigid_vertex", &[Some(vertex), Some(instance)]),
            image: texture(Rgba8UnormSrgb, TextureUsages::COPY_SRC),
            visibility: texture(Rgba8Unorm, TextureUsages::COPY_SRC),
            depths: depths.create_view(&Default::default()),
            layout: layout.clone(),
        }
    }

    /// Draws an image; the maps of `shadows` were recorded before.
    pub fn draw(
        &self,
        gpu: &Gpu,
        encoder: &mut wgpu::CommandEncoder,
        (scene, actors): (&Scene, &[Actor]),
        (camera, lights): (&Camera, &Lights),
        shadows: &Shadows,
    ) {
        let lamp = lights.lamp;
        let frame = FrameUniform {
            clip_from_render: camera.clip_from_render(),
            eye: camera.eye.extend(1.0),
            toward_sun: TOWARD_SUN.normalize().extend(0.0),
            lamp: lamp.position_world.as_vec3().extend(lamp.range),
        };
        let frame = gpu.buffer(&[frame], BufferUsages::UNIFORM);
        let frame = group(gpu, &self.layout, &frame);
        let view = |texture: &wgpu::Texture| texture.create_view(&Default::default());
        let (image, visibility) = (view(&self.image), view(&self.visibility));
        let target = |view, clear| {
            Some(wgpu::RenderPassColorAttachment {
                view,
                depth_slice: None,
                resolve_target: None,
                ops: wgpu::Operations {
                    load: wgpu::LoadOp::Clear(clear),
                    store: wgpu::StoreOp::Store,
                },
            })
        };
        let sky = wgpu::Color {
            r: 0.25,
            g: 0.35,
            b: 0.5,
            a: 1.0,
        };
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("forward"),
            color_attachments: &[target(&image, sky), target(&visibility, wgpu::Color::WHITE)],
            depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                view: &self.depths,
                depth_ops: Some(wgpu::Operations {
                    load: wgpu::LoadOp::Clear(0.0),
                    store: wgpu::StoreOp::Store,
                }),
                stencil_ops: None,
            }),
            ..Default::default()
        });
        pass.set_bind_group(0, &frame, &[]);
        pass.set_bind_group(2, shadows.bindings.bind_group(), &[]);
        pass.set_pipeline(&self.skinned);
        for actor in actors {
            pass.set_bind_group(1, &actor.group, &[]);
            pass.set_vertex_buffer(0, actor.vertices.slice(..));
            pass.set_index_buffer(actor.indices.slice(..), wgpu::IndexFormat::Uint32);
            pass.draw_indexed(0..actor.index_count, 0, 0..1);
        }
        // The rigid objects have no pose. That of the last actor stays bound for them.
        pass.set_pipeline(&self.rigid);
        for object in &scene.rigid {
            pass.set_vertex_buffer(0, object.mesh.vertices.slice(..));
            pass.set_vertex_buffer(1, object.instance.slice(..));
            pass.draw(0..object.mesh.vertex_count, 0..1);
        }
    }
}
