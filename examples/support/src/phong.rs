//! Contains the pass that draws meshes with Blinn-Phong, one light and its shadow.

use std::ops::Range;

use bytemuck::{Pod, Zeroable};
use glam::{Mat4, Vec3, Vec4};
use shadow_support::gpu::Gpu;
use wgpu::util::{BufferInitDescriptor, DeviceExt};

use crate::camera::Camera;
use crate::mesh::{Instance, Mesh, Object, Vertex};

/// Is the format of the depth attachment.
pub const DEPTH_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Depth32Float;

/// Describes what a [`Phong`] is made of.
pub struct PhongDescriptor<'a> {
    /// Is WGSL that defines the visibility functions of the fragment stage.
    pub visibility_wgsl: &'a str,
    /// Is WGSL of the fragment stage, which may call `shade`.
    pub fragment_wgsl: &'a str,
    pub fragment_entry: &'a str,
    /// Is the bind group that visibility is read from.
    pub shadow_group: u32,
    pub shadow_layout: &'a wgpu::BindGroupLayout,
    pub format: wgpu::TextureFormat,
    pub sample_count: u32,
}

/// Describes light and camera of an image.
#[derive(Clone, Copy)]
pub struct Lighting {
    /// Is the direction toward a sun (w = 0), or the position of a point light (w = 1).
    pub light: Vec4,
    pub light_color: Vec3,
    /// Is the distance at which a point light ends.
    pub light_range: f32,
    pub ambient: Vec3,
    /// Is the linear colour where nothing is drawn.
    pub sky: Vec3,
}

/// Describes an image: its camera, its light, its shadows, and its target.
pub struct Picture<'a> {
    pub camera: &'a Camera,
    pub lighting: &'a Lighting,
    /// Is the bind group that visibility is read from.
    pub shadows: &'a wgpu::BindGroup,
    pub target: &'a wgpu::Texture,
}

/// Mirrors `Frame` in `phong.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
struct Frame {
    clip_from_render: Mat4,
    light: Vec4,
    light_color: Vec3,
    light_range: f32,
    ambient: Vec4,
    eye: Vec4,
}

/// Holds instances of one mesh.
pub struct Batch<'a> {
    pub mesh: &'a Mesh,
    pub instances: &'a wgpu::Buffer,
    pub range: Range<u32>,
}

impl<'a> From<&'a Object> for Batch<'a> {
    fn from(object: &'a Object) -> Self {
        Self {
            mesh: &object.mesh,
            instances: &object.instance,
            range: 0..1,
        }
    }
}

/// Holds a pipeline, and the pass around it.
pub struct Phong {
    pipeline: wgpu::RenderPipeline,
    frame_layout: wgpu::BindGroupLayout,
    shadow_group: u32,
    /// Holds further lights than the one of a frame, in the group behind that of the shadows.
    lights: Option<wgpu::BindGroup>,
    format: wgpu::TextureFormat,
    sample_count: u32,
}

impl Phong {
    pub fn new(gpu: &Gpu, descriptor: &PhongDescriptor<'_>) -> Self {
        Self::with_lights(gpu, descriptor, None)
    }

    /// Makes the pass with a bind group of lights for the fragment stage, behind that of the
    /// shadows.
    pub fn with_lights(
        gpu: &Gpu,
        descriptor: &PhongDescriptor<'_>,
        lights: Option<(&wgpu::BindGroupLayout, wgpu::BindGroup)>,
    ) -> Self {
        let layout = wgpu::BindGroupLayoutDescriptor {
            label: Some("frame"),
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
        };
        let frame_layout = gpu.device.create_bind_group_layout(&layout);
        Self {
            pipeline: create_pipeline(
                gpu,
                descriptor,
                &frame_layout,
                lights.as_ref().map(|(layout, _)| *layout),
            ),
            frame_layout,
            shadow_group: descriptor.shadow_group,
            lights: lights.map(|(_, group)| group),
            format: descriptor.format,
            sample_count: descriptor.sample_count,
        }
    }

    /// Draws `batches` over the whole of the image's target.
    pub fn draw<'a>(
        &self,
        gpu: &Gpu,
        encoder: &mut wgpu::CommandEncoder,
        picture: &Picture<'_>,
        batches: impl IntoIterator<Item = Batch<'a>>,
    ) {
        let Picture {
            camera,
            lighting,
            shadows,
            target,
        } = *picture;
        let size = [target.width(), target.height()];
        let depth = gpu.target(DEPTH_FORMAT, size, self.sample_count);
        let multisampled = gpu.target(self.format, size, self.sample_count);
        let multisampled = multisampled.create_view(&Default::default());
        let target = target.create_view(&Default::default());
        let (view, resolve_target) = if self.sample_count > 1 {
            (&multisampled, Some(&target))
        } else {
            (&target, None)
        };
        let [r, g, b] = lighting.sky.as_dvec3().to_array();
        let sky = wgpu::Color { r, g, b, a: 1.0 };
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("scene"),
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view,
                depth_slice: None,
                resolve_target,
                ops: wgpu::Operations {
                    load: wgpu::LoadOp::Clear(sky),
                    store: wgpu::StoreOp::Store,
                },
            })],
            depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                view: &depth.create_view(&Default::default()),
                // Depth is reversed: the far end of the world is 0.
                depth_ops: Some(wgpu::Operations {
                    load: wgpu::LoadOp::Clear(0.0),
                    store: wgpu::StoreOp::Discard,
                }),
                stencil_ops: None,
            }),
            ..Default::default()
        });
        self.draw_in_pass(gpu, &mut pass, camera, lighting, shadows, batches);
    }

    /// Draws `batches` in a pass of the caller's own, with a colour target and samples like those
    /// of this pipeline and a [`DEPTH_FORMAT`] attachment of reversed depth.
    pub fn draw_in_pass<'a>(
        &self,
        gpu: &Gpu,
        pass: &mut wgpu::RenderPass<'_>,
        camera: &Camera,
        lighting: &Lighting,
        shadows: &wgpu::BindGroup,
        batches: impl IntoIterator<Item = Batch<'a>>,
    ) {
        let frame = self.frame(gpu, camera, lighting);
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(0, &frame, &[]);
        pass.set_bind_group(self.shadow_group, shadows, &[]);
        if let Some(lights) = &self.lights {
            pass.set_bind_group(self.shadow_group + 1, lights, &[]);
        }
        for batch in batches {
            pass.set_vertex_buffer(0, batch.mesh.vertices.slice(..));
            pass.set_vertex_buffer(1, batch.instances.slice(..));
            pass.draw(0..batch.mesh.vertex_count, batch.range);
        }
    }

    fn frame(&self, gpu: &Gpu, camera: &Camera, lighting: &Lighting) -> wgpu::BindGroup {
        let frame = Frame {
            clip_from_render: camera.clip_from_render(),
            light: lighting.light,
            light_color: lighting.light_color,
            light_range: lighting.light_range,
            ambient: lighting.ambient.extend(0.0),
            eye: camera.eye.extend(0.0),
        };
        let buffer = gpu.device.create_buffer_init(&BufferInitDescriptor {
            label: Some("frame"),
            contents: bytemuck::bytes_of(&frame),
            usage: wgpu::BufferUsages::UNIFORM,
        });
        gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("frame"),
            layout: &self.frame_layout,
            entries: &[wgpu::BindGroupEntry {
                binding: 0,
                resource: buffer.as_entire_binding(),
            }],
        })
    }
}

fn create_pipeline(
    gpu: &Gpu,
    descriptor: &PhongDescriptor<'_>,
    frame_layout: &wgpu::BindGroupLayout,
    lights_layout: Option<&wgpu::BindGroupLayout>,
) -> wgpu::RenderPipeline {
    let device = &gpu.device;
    let wgsl = [
        descriptor.visibility_wgsl,
        include_str!("phong.wgsl"),
        descriptor.fragment_wgsl,
    ];
    let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: Some("scene"),
        source: wgpu::ShaderSource::Wgsl(wgsl.concat().into()),
    });
    let mut layouts = vec![None; descriptor.shadow_group as usize + 1];
    layouts[0] = Some(frame_layout);
    layouts[descriptor.shadow_group as usize] = Some(descriptor.shadow_layout);
    layouts.extend(lights_layout.map(Some));
    let layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
        label: Some("scene"),
        bind_group_layouts: &layouts,
        immediate_size: 0,
    });
    let vertex = wgpu::vertex_attr_array![0 => Float32x3, 1 => Float32x3];
    let instance = wgpu::vertex_attr_array![
        2 => Float32x4, 3 => Float32x4, 4 => Float32x4, 5 => Float32x4, 6 => Float32x4
    ];
    let buffers = [
        wgpu::VertexBufferLayout {
            array_stride: size_of::<Vertex>() as u64,
            step_mode: wgpu::VertexStepMode::Vertex,
            attributes: &vertex,
        },
        wgpu::VertexBufferLayout {
            array_stride: size_of::<Instance>() as u64,
            step_mode: wgpu::VertexStepMode::Instance,
            attributes: &instance,
        },
    ];
    device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some("scene"),
        layout: Some(&layout),
        vertex: wgpu::VertexState {
            module: &module,
            entry_point: Some("vertex"),
            compilation_options: Default::default(),
            buffers: &buffers.map(Some),
        },
        primitive: wgpu::PrimitiveState {
            cull_mode: Some(wgpu::Face::Back),
            ..Default::default()
        },
        depth_stencil: Some(wgpu::DepthStencilState {
            format: DEPTH_FORMAT,
            depth_write_enabled: Some(true),
            depth_compare: Some(wgpu::CompareFunction::Greater),
            stencil: Default::default(),
            bias: Default::default(),
        }),
        multisample: wgpu::MultisampleState {
            count: descriptor.sample_count,
            ..Default::default()
        },
        fragment: Some(wgpu::FragmentState {
            module: &module,
            entry_point: Some(descriptor.fragment_entry),
            compilation_options: Default::default(),
            targets: &[Some(descriptor.format.into())],
        }),
        multiview_mask: None,
        cache: None,
    })
}
