//! Creates the pipelines and records the passes of the image and of the visibility image.

use example_support::gltf_file::scene::Scene;
use image::DynamicImage;
use shadow_support::{gpu::Gpu, readback};

use crate::geometry::{Geometry, INSTANCE_LAYOUT, VERTEX_LAYOUT};
use crate::lights::{LightUniform, MAX_LIGHTS, SceneLights};

const COLOR_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8UnormSrgb;
const VISIBILITY_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::R8Unorm;
const DEPTH_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Depth32Float;
const SAMPLES: u32 = 4;
/// Is the linear colour where nothing is drawn.
const SKY: wgpu::Color = wgpu::Color {
    r: 0.35,
    g: 0.48,
    b: 0.66,
    a: 1.0,
};

/// Mirrors `Frame` in `shade.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, bytemuck::Pod, bytemuck::Zeroable)]
struct FrameUniform {
    clip_from_render: [[f32; 4]; 4],
    light_count: u32,
    exposure: f32,
    padding: [f32; 2],
}

/// Holds one pipeline per way of winding and culling.
struct Sided {
    back_culled: wgpu::RenderPipeline,
    back_culled_mirrored: wgpu::RenderPipeline,
    double_sided: wgpu::RenderPipeline,
}

pub struct Renderer {
    shade: Sided,
    visibility: Sided,
    frame_uniform: wgpu::Buffer,
    light_uniform: wgpu::Buffer,
    frame_group: wgpu::BindGroup,
    color: wgpu::Texture,
    multisampled: wgpu::TextureView,
    depth: wgpu::TextureView,
    size: [u32; 2],
}

impl Renderer {
    pub fn new(
        gpu: &Gpu,
        geometry: &Geometry,
        lights: &SceneLights,
        size: [u32; 2],
    ) -> Result<Self, String> {
        let device = &gpu.device;
        let most = device.limits().max_texture_dimension_2d;
        if size[0].max(size[1]) > most {
            return Err(format!(
                "the device draws pictures of at most {most} pixels a side"
            ));
        }
        let uniform = |label, size| {
            device.create_buffer(&wgpu::BufferDescriptor {
                label: Some(label),
                size,
                usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
                mapped_at_creation: false,
            })
        };
        let frame_uniform = uniform("frame", size_of::<FrameUniform>() as u64);
        let light_uniform = uniform("lights", (MAX_LIGHTS * size_of::<LightUniform>()) as u64);
        let buffer_entry = |binding| wgpu::BindGroupLayoutEntry {
            binding,
            visibility: wgpu::ShaderStages::VERTEX_FRAGMENT,
            ty: wgpu::BindingType::Buffer {
                ty: wgpu::BufferBindingType::Uniform,
                has_dynamic_offset: false,
                min_binding_size: None,
            },
            count: None,
        };
        let frame_layout = device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: Some("frame"),
            entries: &[buffer_entry(0), buffer_entry(1)],
        });
        let frame_group = device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("frame"),
            layout: &frame_layout,
            entries: &[
                wgpu::BindGroupEntry {
                    binding: 0,
                    resource: frame_uniform.as_entire_binding(),
                },
                wgpu::BindGroupEntry {
                    binding: 1,
                    resource: light_uniform.as_entire_binding(),
                },
            ],
        });
        let source = format!(
            "const MAX_LIGHTS: u32 = {MAX_LIGHTS}u;\n{}{}{}",
            include_str!("shade.wgsl"),
            lights.bindings.wgsl(),
            lights.wgsl
        );
        let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
            label: Some("shade"),
            source: wgpu::ShaderSource::Wgsl(source.into()),
        });
        let layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: Some("shade"),
            bind_group_layouts: &[
                Some(&frame_layout),
                Some(lights.bindings.layout()),
                Some(&geometry.material_layout),
            ],
            immediate_size: 0,
        });
        let sided = |entry, format, samples| Sided {
            back_culled: pipeline(
                device,
                &layout,
                &module,
                entry,
                format,
                samples,
                Some(wgpu::FrontFace::Ccw),
            ),
            back_culled_mirrored: pipeline(
                device,
                &layout,
                &module,
                entry,
                format,
                samples,
                Some(wgpu::FrontFace::Cw),
            ),
            double_sided: pipeline(device, &layout, &module, entry, format, samples, None),
        };
        let color = target(device, COLOR_FORMAT, size, 1);
        Ok(Self {
            shade: sided("shade", COLOR_FORMAT, SAMPLES),
            visibility: sided("visibility", VISIBILITY_FORMAT, 1),
            frame_uniform,
            light_uniform,
            frame_group,
            color,
            multisampled: view(&target(device, COLOR_FORMAT, size, SAMPLES)),
            depth: view(&target(device, DEPTH_FORMAT, size, SAMPLES)),
            size,
        })
    }

    pub fn write_uniforms(&self, gpu: &Gpu, scene: &Scene, lights: &SceneLights) {
        let camera = &scene.camera;
        let frame = FrameUniform {
            clip_from_render: (camera.clip_from_view * camera.view_from_render).to_cols_array_2d(),
            light_count: lights.lights.len() as u32,
            exposure: lights.exposure(scene),
            padding: [0.0; 2],
        };
        gpu.queue
            .write_buffer(&self.frame_uniform, 0, bytemuck::bytes_of(&frame));
        gpu.queue.write_buffer(
            &self.light_uniform,
            0,
            bytemuck::cast_slice(&lights.uniforms()),
        );
    }

    /// Records the image.
    pub fn shade(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        geometry: &Geometry,
        lights: &SceneLights,
    ) {
        let resolved = view(&self.color);
        let attachment = wgpu::RenderPassColorAttachment {
            view: &self.multisampled,
            depth_slice: None,
            resolve_target: Some(&resolved),
            ops: wgpu::Operations {
                load: wgpu::LoadOp::Clear(SKY),
                store: wgpu::StoreOp::Discard,
            },
        };
        self.draw(
            encoder,
            &self.shade,
            attachment,
            &self.depth,
            geometry,
            lights,
        );
    }

    pub fn read_color(&self, gpu: &Gpu) -> Result<DynamicImage, String> {
        let rgba = readback::texels(gpu, gpu.encoder(), &self.color)?;
        image::RgbaImage::from_raw(self.size[0], self.size[1], rgba)
            .map(DynamicImage::ImageRgba8)
            .ok_or_else(|| "the picture came back with the wrong size".to_owned())
    }

    /// Records the visibility of the first light: one sample per pixel, 255 for lit.
    pub fn visibility(
        &self,
        gpu: &Gpu,
        _scene: &Scene,
        geometry: &Geometry,
        lights: &SceneLights,
    ) -> Result<DynamicImage, String> {
        let picture = target(&gpu.device, VISIBILITY_FORMAT, self.size, 1);
        let depth = view(&target(&gpu.device, DEPTH_FORMAT, self.size, 1));
        let mut encoder = gpu.encoder();
        let attachment = wgpu::RenderPassColorAttachment {
            view: &view(&picture),
            depth_slice: None,
            resolve_target: None,
            ops: wgpu::Operations {
                load: wgpu::LoadOp::Clear(wgpu::Color::WHITE),
                store: wgpu::StoreOp::Store,
            },
        };
        self.draw(
            &mut encoder,
            &self.visibility,
            attachment,
            &depth,
            geometry,
            lights,
        );
        let grey = readback::texels(gpu, encoder, &picture)?;
        image::GrayImage::from_raw(self.size[0], self.size[1], grey)
            .map(DynamicImage::ImageLuma8)
            .ok_or_else(|| "the picture came back with the wrong size".to_owned())
    }

    fn draw(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        pipelines: &Sided,
        attachment: wgpu::RenderPassColorAttachment<'_>,
        depth: &wgpu::TextureView,
        geometry: &Geometry,
        lights: &SceneLights,
    ) {
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("shade"),
            color_attachments: &[Some(attachment)],
            depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                view: depth,
                depth_ops: Some(wgpu::Operations {
                    load: wgpu::LoadOp::Clear(0.0),
                    store: wgpu::StoreOp::Discard,
                }),
                stencil_ops: None,
            }),
            ..Default::default()
        });
        pass.set_bind_group(0, &self.frame_group, &[]);
        pass.set_bind_group(1, lights.bindings.bind_group(), &[]);
        for draw in &geometry.draws {
            let double_sided = geometry.materials[draw.material].double_sided;
            pass.set_pipeline(match (double_sided, draw.mirrored) {
                (true, _) => &pipelines.double_sided,
                (false, false) => &pipelines.back_culled,
                (false, true) => &pipelines.back_culled_mirrored,
            });
            pass.set_bind_group(2, &geometry.material_groups[draw.material], &[]);
            geometry.draw(&mut pass, draw);
        }
    }
}

/// Creates a pipeline. With `front_face` `None`, both sides are drawn.
fn pipeline(
    device: &wgpu::Device,
    layout: &wgpu::PipelineLayout,
    module: &wgpu::ShaderModule,
    entry: &str,
    format: wgpu::TextureFormat,
    samples: u32,
    front_face: Option<wgpu::FrontFace>,
) -> wgpu::RenderPipeline {
    device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some(entry),
        layout: Some(layout),
        vertex: wgpu::VertexState {
            module,
            entry_point: Some("vertex"),
            compilation_options: Default::default(),
            buffers: &[Some(VERTEX_LAYOUT), Some(INSTANCE_LAYOUT)],
        },
        primitive: wgpu::PrimitiveState {
            front_face: front_face.unwrap_or_default(),
            cull_mode: front_face.map(|_| wgpu::Face::Back),
            ..Default::default()
        },
        depth_stencil: Some(wgpu::DepthStencilState {
            format: DEPTH_FORMAT,
            depth_write_enabled: Some(true),
            depth_compare: Some(wgpu::CompareFunction::GreaterEqual),
            stencil: Default::default(),
            bias: Default::default(),
        }),
        multisample: wgpu::MultisampleState {
            count: samples,
            ..Default::default()
        },
        fragment: Some(wgpu::FragmentState {
            module,
            entry_point: Some(entry),
            compilation_options: Default::default(),
            targets: &[Some(format.into())],
        }),
        multiview_mask: None,
        cache: None,
    })
}

fn target(
    device: &wgpu::Device,
    format: wgpu::TextureFormat,
    size: [u32; 2],
    samples: u32,
) -> wgpu::Texture {
    let usage = wgpu::TextureUsages::RENDER_ATTACHMENT;
    device.create_texture(&wgpu::TextureDescriptor {
        label: Some("target"),
        size: wgpu::Extent3d {
            width: size[0],
            height: size[1],
            depth_or_array_layers: 1,
        },
        mip_level_count: 1,
        sample_count: samples,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage: if samples == 1 {
            usage | wgpu::TextureUsages::COPY_SRC
        } else {
            usage
        },
        view_formats: &[],
    })
}

fn view(texture: &wgpu::Texture) -> wgpu::TextureView {
    texture.create_view(&Default::default())
}
