//! Draws depth, normal and albedo of each pixel, and lights them in compute shaders.

use bytemuck::{Pod, Zeroable};
use example_support::camera::Camera;
use example_support::mesh::{Instance, Vertex, vertex_buffer};
use glam::{Mat4, Vec4};
use shadow_support::bind::{UNIFORM, depth_texture, group, layout};
use shadow_support::gpu::Gpu;
use wgpu::TextureFormat::{Depth32Float, Rgba8Unorm, Rgba16Float};
use wgpu::{ShaderStages, TextureUsages};
use wgpu_shadows::ShadowBindings;

use crate::scene::{Lights, Scene, TOWARD_SUN};

#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
struct CameraUniform {
    clip_from_render: Mat4,
    render_from_clip: Mat4,
    eye: Vec4,
}

#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
struct LightsUniform {
    toward_sun: Vec4,
    spot_position: Vec4,
    spot_direction: Vec4,
    lamp_position: Vec4,
    cone_and_ranges: Vec4,
}

/// Is one pass of a compute shader over all pixels.
struct FullPass {
    pipeline: wgpu::ComputePipeline,
    layout: wgpu::BindGroupLayout,
}

pub struct Renderer {
    size: [u32; 2],
    depths: wgpu::TextureView,
    normals: wgpu::TextureView,
    albedos: wgpu::TextureView,
    /// Holds the visibility of sun, spot light and lamp in its components.
    pub visibility: wgpu::Texture,
    pub image: wgpu::Texture,
    camera_layout: wgpu::BindGroupLayout,
    gbuffer: wgpu::RenderPipeline,
    look_up: FullPass,
    shade: FullPass,
}

impl Renderer {
    pub fn new(gpu: &Gpu, size: [u32; 2], shadows: &ShadowBindings) -> Self {
        let texture = |format, usage| {
            gpu.device.create_texture(&wgpu::TextureDescriptor {
                label: Some("pixels"),
                size: wgpu::Extent3d {
                    width: size[0],
                    height: size[1],
                    depth_or_array_layers: 1,
                },
                mip_level_count: 1,
                sample_count: 1,
                dimension: wgpu::TextureDimension::D2,
                format,
                usage: usage | TextureUsages::TEXTURE_BINDING,
                view_formats: &[],
            })
        };
        let target = |format| {
            texture(format, TextureUsages::RENDER_ATTACHMENT).create_view(&Default::default())
        };
        let stored = || {
            texture(
                Rgba8Unorm,
                TextureUsages::STORAGE_BINDING | TextureUsages::COPY_SRC,
            )
        };
        let camera_layout = layout(gpu, ShaderStages::VERTEX_FRAGMENT, &[UNIFORM]);
        let look_up = FullPass::new(
            gpu,
            "look_up",
            &[shadows.wgsl(), CAMERA, include_str!("visibility.wgsl")],
            &[
                UNIFORM,
                depth_texture(wgpu::TextureViewDimension::D2),
                PIXELS,
                STORED,
            ],
            Some(shadows.layout()),
        );
        let shade = FullPass::new(
            gpu,
            "shade",
            &[CAMERA, include_str!("shade.wgsl")],
            &[
                UNIFORM,
                UNIFORM,
                depth_texture(wgpu::TextureViewDimension::D2),
                PIXELS,
                PIXELS,
                PIXELS,
                STORED,
            ],
            None,
        );
        Self {
            size,
            depths: target(Depth32Float),
            normals: target(Rgba16Float),
            albedos: target(Rgba8Unorm),
            visibility: stored(),
            image: stored(),
            gbuffer: gbuffer_pipeline(gpu, &camera_layout),
            camera_layout,
            look_up,
            shade,
        }
    }

    /// Draws an image; the maps of `shadows` were recorded before.
    pub fn draw(
        &self,
        gpu: &Gpu,
        encoder: &mut wgpu::CommandEncoder,
        scene: &Scene,
        camera: &Camera,
        lights: &Lights,
        shadows: &wgpu::BindGroup,
    ) {
        let clip_from_render = camera.clip_from_render();
        let render_from_clip = clip_from_render.as_dmat4().inverse().as_mat4();
        let camera = CameraUniform {
            clip_from_render,
            render_from_clip,
            eye: camera.eye.extend(1.0),
        };
        let spot = lights.spot;
        let lights = LightsUniform {
            toward_sun: TOWARD_SUN.normalize().extend(0.0),
            spot_position: spot.position_world.as_vec3().extend(1.0),
            spot_direction: spot.direction.normalize().extend(0.0),
            lamp_position: lights.lamp.position_world.as_vec3().extend(1.0),
            cone_and_ranges: Vec4::new(
                spot.outer_angle_radians.cos(),
                (0.8 * spot.outer_angle_radians).cos(),
                spot.range,
                lights.lamp.range,
            ),
        };
        let camera = gpu.buffer(&[camera], wgpu::BufferUsages::UNIFORM);
        let lights = gpu.buffer(&[lights], wgpu::BufferUsages::UNIFORM);

        self.draw_gbuffer(gpu, encoder, scene, &camera);
        let view = |texture: &wgpu::Texture| texture.create_view(&Default::default());
        let (visibility, image) = (view(&self.visibility), view(&self.image));
        let texture = wgpu::BindingResource::TextureView;
        let resources = [
            camera.as_entire_binding(),
            texture(&self.depths),
            texture(&self.normals),
            texture(&visibility),
        ];
        self.look_up
            .record(gpu, encoder, self.size, &resources, Some(shadows));
        let resources = [
            camera.as_entire_binding(),
            lights.as_entire_binding(),
            texture(&self.depths),
            texture(&self.normals),
            texture(&self.albedos),
            texture(&visibility),
            texture(&image),
        ];
        self.shade.record(gpu, encoder, self.size, &resources, None);
    }

    fn draw_gbuffer(
        &self,
        gpu: &Gpu,
        encoder: &mut wgpu::CommandEncoder,
        scene: &Scene,
        camera: &wgpu::Buffer,
    ) {
        let attachment = |view| {
            Some(wgpu::RenderPassColorAttachment {
                view,
                depth_slice: None,
                resolve_target: None,
                ops: wgpu::Operations::default(),
            })
        };
        let instances: Vec<Instance> = (0..scene.objects.len())
            .map(|index| scene.instance(index))
            .collect();
        let instances = vertex_buffer(&gpu.device, &instances);
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("G-buffer"),
            color_attachments: &[attachment(&self.normals), attachment(&self.albedos)],
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
        pass.set_pipeline(&self.gbuffer);
        let camera = group(gpu, &self.camera_layout, &[camera.as_entire_binding()]);
        pass.set_bind_group(0, &camera, &[]);
        pass.set_vertex_buffer(1, instances.slice(..));
        for (index, object) in (0..).zip(&scene.objects) {
            let mesh = &scene.meshes[object.mesh];
            pass.set_vertex_buffer(0, mesh.vertices.slice(..));
            pass.draw(0..mesh.vertex_count, index..index + 1);
        }
    }
}

const CAMERA: &str = include_str!("camera.wgsl");

/// Is the type of a colour texture that is read pixel by pixel.
const PIXELS: wgpu::BindingType = wgpu::BindingType::Texture {
    sample_type: wgpu::TextureSampleType::Float { filterable: false },
    view_dimension: wgpu::TextureViewDimension::D2,
    multisampled: false,
};

/// Is the type of the texture that a pass writes.
const STORED: wgpu::BindingType = wgpu::BindingType::StorageTexture {
    access: wgpu::StorageTextureAccess::WriteOnly,
    format: Rgba8Unorm,
    view_dimension: wgpu::TextureViewDimension::D2,
};

impl FullPass {
    fn new(
        gpu: &Gpu,
        entry_point: &str,
        wgsl: &[&str],
        types: &[wgpu::BindingType],
        shadows: Option<&wgpu::BindGroupLayout>,
    ) -> Self {
        let layout = layout(gpu, ShaderStages::COMPUTE, types);
        let groups = [Some(&layout), shadows];
        let pipeline_layout = gpu
            .device
            .create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
                label: Some(entry_point),
                bind_group_layouts: &groups[..1 + usize::from(shadows.is_some())],
                immediate_size: 0,
            });
        let pipeline = gpu
            .device
            .create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
                label: Some(entry_point),
                layout: Some(&pipeline_layout),
                module: &gpu.shader(&wgsl.concat()),
                entry_point: Some(entry_point),
                compilation_options: Default::default(),
                cache: None,
            });
        Self { pipeline, layout }
    }

    fn record(
        &self,
        gpu: &Gpu,
        encoder: &mut wgpu::CommandEncoder,
        [width, height]: [u32; 2],
        resources: &[wgpu::BindingResource<'_>],
        shadows: Option<&wgpu::BindGroup>,
    ) {
        let resources = group(gpu, &self.layout, resources);
        let mut pass = encoder.begin_compute_pass(&Default::default());
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(0, &resources, &[]);
        if shadows.is_some() {
            pass.set_bind_group(1, shadows, &[]);
        }
        pass.dispatch_workgroups(width.div_ceil(8), height.div_ceil(8), 1);
    }
}

fn gbuffer_pipeline(gpu: &Gpu, camera_layout: &wgpu::BindGroupLayout) -> wgpu::RenderPipeline {
    let normal = wgpu_shadows::shader::compose(&["normal"]).expect("a module of the library");
    let module = gpu.shader(&(normal + CAMERA + include_str!("gbuffer.wgsl")));
    let layout = gpu
        .device
        .create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: Some("G-buffer"),
            bind_group_layouts: &[Some(camera_layout)],
            immediate_size: 0,
        });
    let vertex = wgpu::vertex_attr_array![0 => Float32x3];
    let instance = wgpu::vertex_attr_array![
        1 => Float32x4, 2 => Float32x4, 3 => Float32x4, 4 => Float32x4, 5 => Float32x4
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
    gpu.device
        .create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: Some("G-buffer"),
            layout: Some(&layout),
            vertex: wgpu::VertexState {
                module: &module,
                entry_point: Some("surface"),
                compilation_options: Default::default(),
                buffers: &buffers.map(Some),
            },
            fragment: Some(wgpu::FragmentState {
                module: &module,
                entry_point: Some("write"),
                compilation_options: Default::default(),
                targets: &[Some(Rgba16Float.into()), Some(Rgba8Unorm.into())],
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
}
