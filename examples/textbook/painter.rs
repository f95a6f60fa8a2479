//! The engine's passes: the picture with four samples a pixel, and the visibility alone with one, for measuring.

use std::error::Error;

use glam::{Mat4, Vec4};
use image::RgbaImage;
use wgpu::util::{BufferInitDescriptor, DeviceExt};

use crate::camera::Camera;
use crate::gpu::Gpu;
use crate::lookup::{GROUP, Lookup};
use crate::mesh::{Instance, Vertex};
use crate::scene::Scene;

/// Width and height of the pictures.
pub const SIZE: [u32; 2] = [960, 540];

const DEPTH_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Depth32Float;

/// What a pass draws.
struct Output {
    fragment_entry: &'static str,
    format: wgpu::TextureFormat,
    sample_count: u32,
}

const PICTURE: Output = Output {
    fragment_entry: "fragment_picture",
    format: wgpu::TextureFormat::Rgba8UnormSrgb,
    sample_count: 4,
};

const VISIBILITY: Output = Output {
    fragment_entry: "fragment_visibility",
    format: wgpu::TextureFormat::Rgba8Unorm,
    sample_count: 1,
};

/// Mirror of `Frame` in `scene.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, bytemuck::Pod, bytemuck::Zeroable)]
struct Frame {
    clip_from_render: Mat4,
    eye: Vec4,
    toward_light: Vec4,
}

/// The scene as drawn with one lookup.
pub struct Painted {
    pub picture: RgbaImage,
    /// Row by row, one value a pixel, at its centre, to 1/255.
    pub visibility: Vec<f32>,
}

/// Draws the scene as a camera sees it.
pub struct Painter<'a> {
    gpu: &'a Gpu,
    scene: &'a Scene,
    frame_layout: wgpu::BindGroupLayout,
    frame: wgpu::BindGroup,
}

impl<'a> Painter<'a> {
    pub fn new(gpu: &'a Gpu, scene: &'a Scene, camera: &Camera) -> Self {
        let frame = Frame {
            clip_from_render: camera.clip_from_render(),
            eye: camera.eye.extend(1.0),
            toward_light: scene.toward_light.extend(0.0),
        };
        let buffer = gpu.device.create_buffer_init(&BufferInitDescriptor {
            label: Some("frame"),
            contents: bytemuck::bytes_of(&frame),
            usage: wgpu::BufferUsages::UNIFORM,
        });
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
        let frame = gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("frame"),
            layout: &frame_layout,
            entries: &[wgpu::BindGroupEntry {
                binding: 0,
                resource: buffer.as_entire_binding(),
            }],
        });
        Self {
            gpu,
            scene,
            frame_layout,
            frame,
        }
    }

    /// Draws after what `encoder` holds, submits, and reads both outputs back.
    pub fn paint(
        &self,
        mut encoder: wgpu::CommandEncoder,
        lookup: &Lookup,
    ) -> Result<Painted, Box<dyn Error>> {
        let picture = self.gpu.target(PICTURE.format, SIZE, 1);
        self.draw(&mut encoder, lookup, &PICTURE, &picture);
        let visibility = self.gpu.target(VISIBILITY.format, SIZE, 1);
        self.draw(&mut encoder, lookup, &VISIBILITY, &visibility);

        let picture = self.gpu.read(encoder, &picture)?;
        let encoder = self.gpu.device.create_command_encoder(&Default::default());
        let visibility = self.gpu.read(encoder, &visibility)?;
        Ok(Painted {
            picture: RgbaImage::from_raw(SIZE[0], SIZE[1], picture).ok_or("incomplete picture")?,
            visibility: visibility
                .chunks_exact(4)
                .map(|pixel| f32::from(pixel[0]) / 255.0)
                .collect(),
        })
    }

    fn draw(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        lookup: &Lookup,
        output: &Output,
        target: &wgpu::Texture,
    ) {
        let pipeline = self.pipeline(lookup, output);
        let target = target.create_view(&Default::default());
        let samples = output.sample_count;
        let depth = self.gpu.target(DEPTH_FORMAT, SIZE, samples);
        let multisampled = self.gpu.target(output.format, SIZE, samples);
        let multisampled = multisampled.create_view(&Default::default());
        let (view, resolve_target) = if samples > 1 {
            (&multisampled, Some(&target))
        } else {
            (&target, None)
        };
        let sky = wgpu::Color {
            r: 0.45,
            g: 0.55,
            b: 0.70,
            a: 1.0,
        };
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
                // Reversed depth: the far end of the world is 0.
                depth_ops: Some(wgpu::Operations {
                    load: wgpu::LoadOp::Clear(0.0),
                    store: wgpu::StoreOp::Discard,
                }),
                stencil_ops: None,
            }),
            ..Default::default()
        });
        pass.set_pipeline(&pipeline);
        pass.set_bind_group(0, &self.frame, &[]);
        pass.set_bind_group(GROUP, &lookup.bind_group, &[]);
        for object in self.scene.objects() {
            pass.set_vertex_buffer(0, object.vertices.slice(..));
            pass.set_vertex_buffer(1, object.instance.slice(..));
            pass.draw(0..object.vertex_count, 0..1);
        }
    }

    fn pipeline(&self, lookup: &Lookup, output: &Output) -> wgpu::RenderPipeline {
        let device = &self.gpu.device;
        let wgsl = [&lookup.wgsl, include_str!("scene.wgsl")].concat();
        let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
            label: Some("scene"),
            source: wgpu::ShaderSource::Wgsl(wgsl.into()),
        });
        let layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: Some("scene"),
            bind_group_layouts: &[Some(&self.frame_layout), Some(&lookup.layout)],
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
                count: output.sample_count,
                ..Default::default()
            },
            fragment: Some(wgpu::FragmentState {
                module: &module,
                entry_point: Some(output.fragment_entry),
                compilation_options: Default::default(),
                targets: &[Some(output.format.into())],
            }),
            multiview_mask: None,
            cache: None,
        })
    }
}
