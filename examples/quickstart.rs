//! Draws three cubes, a floor and a sun: everything that an engine does for its shadows, and a
//! small engine to do it in.
//!
//! `cargo run --example quickstart [PICTURE.png]` draws `target/quickstart.png`, or the file named.
//! The parts to copy are the function `draw` and the call of `shadow_sun` in the shader; what
//! follows `draw` stands for your own engine.

use std::{error::Error, path::Path, process::ExitCode};

use glam::camera::rh::{proj::directx::perspective_infinite_reverse, view::look_at_mat4};
use glam::{DVec3, Mat4, Vec3};
use wgpu::util::{BufferInitDescriptor, DeviceExt};
use wgpu_shadows::{
    Aabb, CameraView, CasterPipeline, Casters, Coverage, DirectionalLight, DirectionalShadow,
    DirectionalShadowDescriptor, MeshCaster, ShadowBindings, ShadowBindingsDescriptor,
    ShadowCaster, ShadowFrameDescriptor, ShadowScene, caster::CasterPipelineDescriptor,
    caster::MeshCasterDescriptor, caster::MeshIndices,
};

/// Is the engine's own shader. The library's WGSL precedes it and defines the two functions that
/// begin with `shadow_`.
const SCENE_WGSL: &str = "
struct Frame { clip_from_render: mat4x4<f32>, eye: vec4<f32>, toward_light: vec4<f32> }
@group(0) @binding(0) var<uniform> frame: Frame;

struct Surface {
    @builtin(position) clip: vec4<f32>,
    @location(0) position: vec3<f32>,
    @location(1) color: vec3<f32>,
}

@vertex fn vertex(
    @builtin(instance_index) instance: u32, @location(0) position: vec3<f32>,
    @location(1) x: vec4<f32>, @location(2) y: vec4<f32>, @location(3) z: vec4<f32>, @location(4) w: vec4<f32>,
) -> Surface {
    var colors = array(vec3(0.5), vec3(0.8, 0.3, 0.2), vec3(0.3, 0.6, 0.3), vec3(0.2, 0.4, 0.8));
    let position_render = mat4x4(x, y, z, w) * vec4(position, 1.0);
    return Surface(frame.clip_from_render * position_render, position_render.xyz, colors[instance]);
}

@fragment fn fragment(surface: Surface) -> @location(0) vec4<f32> {
    let normal = shadow_geometric_normal(surface.position, frame.eye.xyz - surface.position);
    let visibility = shadow_sun(surface.position, normal);

    let toward_light = frame.toward_light.xyz;
    let halfway = normalize(toward_light + normalize(frame.eye.xyz - surface.position));
    let diffuse = visibility * max(dot(normal, toward_light), 0.0);
    let specular = visibility * 0.2 * pow(max(dot(normal, halfway), 0.0), 32.0);
    return vec4((0.15 + diffuse) * surface.color + specular, 1.0);
}";

fn main() -> ExitCode {
    let argument = std::env::args_os().nth(1);
    let path = argument.unwrap_or_else(|| "target/quickstart.png".into());
    match Engine::new().and_then(|engine| draw(&engine, path.as_ref())) {
        Ok(()) => {
            println!("wrote {}", path.display());
            ExitCode::SUCCESS
        }
        Err(error) => {
            eprintln!("quickstart: {error}");
            ExitCode::FAILURE
        }
    }
}

fn draw(engine: &Engine, path: &Path) -> Result<(), Box<dyn Error>> {
    let device = &engine.device;
    let unit_cube = Aabb::new(Vec3::NEG_ONE, Vec3::ONE);
    let [floor, cubes @ ..] = &engine.render_from_cube;

    // At load time: create the casters, the light, and the bind group and WGSL by which shaders
    // sample it. The scene is reused as well, for all lights and all frames.
    let pipeline = CasterPipeline::new(device, &CasterPipelineDescriptor::default())?;
    let caster = |render_from_model: &Mat4| {
        MeshCaster::new(
            device,
            &MeshCasterDescriptor {
                label: Some("cube"),
                pipeline: &pipeline,
                vertices: &engine.vertices,
                indices: MeshIndices::None { vertices: 0..36 },
                bounds_model: unit_cube,
                render_from_model: *render_from_model,
            },
        )
    };
    let cubes: Vec<MeshCaster> = cubes.iter().map(caster).collect::<Result<_, _>>()?;
    let mut scene = ShadowScene::new();
    let mut sun = DirectionalShadow::new(device, &DirectionalShadowDescriptor::default())?;
    let bindings = ShadowBindings::new(
        device,
        &ShadowBindingsDescriptor {
            lights: &[("sun", sun.maps())],
            ..Default::default()
        },
    )?;

    // In every frame: state where the camera is, what casts, and what only receives; then record
    // each light.
    let casters: Vec<&dyn ShadowCaster> = cubes.iter().map(|cube| cube as _).collect();
    let camera = CameraView::new(engine.view_from_render, engine.clip_from_view);
    let frame = scene.frame(&ShadowFrameDescriptor {
        origin: DVec3::ZERO,
        coverage: Coverage::Cameras(&[camera]),
        casters: Casters::List(&casters),
        receivers: &[unit_cube.transformed(floor)],
    })?;
    let light = DirectionalLight::new(-engine.toward_light);
    let mut encoder = device.create_command_encoder(&Default::default());
    sun.record(&mut encoder, &frame, &light)?;

    // The engine's own pass follows in the same encoder; it sets the library's bind group at the
    // index that it chose.
    engine.paint(encoder, &bindings, path)
}

// From here on nothing concerns shadows but `bindings.wgsl()`, `bindings.layout()` and
// `bindings.bind_group()`.

const SIZE: wgpu::Extent3d = wgpu::Extent3d {
    width: 960,
    height: 540,
    depth_or_array_layers: 1,
};
const COLOR_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8UnormSrgb;
const DEPTH_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Depth32Float;

/// Holds a graphics device, and a scene of one mesh that is drawn four times: a floor and three
/// cubes.
struct Engine {
    device: wgpu::Device,
    queue: wgpu::Queue,
    vertices: wgpu::Buffer,
    render_from_cube: [Mat4; 4],
    eye: Vec3,
    view_from_render: Mat4,
    clip_from_view: Mat4,
    toward_light: Vec3,
}

impl Engine {
    fn new() -> Result<Self, Box<dyn Error>> {
        let options = wgpu::InstanceDescriptor::new_without_display_handle_from_env();
        let adapter = wgpu::Instance::new(options).request_adapter(&Default::default());
        let adapter = pollster::block_on(adapter).map_err(|_| {
            "no graphics adapter; one in software comes with `apt-get install mesa-vulkan-drivers` (.ci/with-vulkan)"
        })?;
        let (device, queue) = pollster::block_on(adapter.request_device(&Default::default()))?;
        let cube = |center: [f32; 3], half: [f32; 3]| {
            Mat4::from_translation(center.into()) * Mat4::from_scale(half.into())
        };
        let eye = Vec3::new(-4.0, 4.0, 6.0);
        Ok(Self {
            vertices: buffer(&device, &cube_corners(), wgpu::BufferUsages::VERTEX),
            render_from_cube: [
                cube([0.0, -0.1, 0.0], [25.0, 0.1, 25.0]),
                cube([0.0, 1.5, 0.0], [0.5; 3]),
                cube([2.0, 0.5, 1.0], [0.5; 3]),
                cube([-1.0, 0.3, 2.0], [0.3; 3]),
            ],
            eye,
            view_from_render: look_at_mat4(eye, Vec3::new(0.8, 0.6, 0.9), Vec3::Y),
            clip_from_view: perspective_infinite_reverse(0.6, 960.0 / 540.0, 0.1),
            toward_light: Vec3::new(-2.0, 4.0, -1.0).normalize(),
            device,
            queue,
        })
    }

    fn pipeline(&self, bindings: &ShadowBindings) -> wgpu::RenderPipeline {
        let module = self
            .device
            .create_shader_module(wgpu::ShaderModuleDescriptor {
                label: Some("scene"),
                source: wgpu::ShaderSource::Wgsl([bindings.wgsl(), SCENE_WGSL].concat().into()),
            });
        let frame = self
            .device
            .create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
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
            });
        let layout = self
            .device
            .create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
                bind_group_layouts: &[Some(&frame), Some(bindings.layout())],
                ..Default::default()
            });
        let position = wgpu::vertex_attr_array![0 => Float32x3];
        let matrix = wgpu::vertex_attr_array![1 => Float32x4, 2 => Float32x4, 3 => Float32x4, 4 => Float32x4];
        let slot = |array_stride, step_mode, attributes| {
            Some(wgpu::VertexBufferLayout {
                array_stride,
                step_mode,
                attributes,
            })
        };
        self.device
            .create_render_pipeline(&wgpu::RenderPipelineDescriptor {
                label: Some("scene"),
                layout: Some(&layout),
                vertex: wgpu::VertexState {
                    module: &module,
                    entry_point: None,
                    compilation_options: Default::default(),
                    buffers: &[
                        slot(12, wgpu::VertexStepMode::Vertex, &position),
                        slot(64, wgpu::VertexStepMode::Instance, &matrix),
                    ],
                },
                primitive: Default::default(),
                depth_stencil: Some(wgpu::DepthStencilState {
                    format: DEPTH_FORMAT,
                    depth_write_enabled: Some(true),
                    depth_compare: Some(wgpu::CompareFunction::Greater),
                    stencil: Default::default(),
                    bias: Default::default(),
                }),
                multisample: Default::default(),
                fragment: Some(wgpu::FragmentState {
                    module: &module,
                    entry_point: None,
                    compilation_options: Default::default(),
                    targets: &[Some(COLOR_FORMAT.into())],
                }),
                multiview_mask: None,
                cache: None,
            })
    }

    fn paint(
        &self,
        mut encoder: wgpu::CommandEncoder,
        bindings: &ShadowBindings,
        path: &Path,
    ) -> Result<(), Box<dyn Error>> {
        let pipeline = self.pipeline(bindings);
        let instances = buffer(
            &self.device,
            &self.render_from_cube,
            wgpu::BufferUsages::VERTEX,
        );
        let frame = [
            &(self.clip_from_view * self.view_from_render).to_cols_array()[..],
            &self.eye.extend(1.0).to_array(),
            &self.toward_light.extend(0.0).to_array(),
        ];
        let frame = buffer(&self.device, &frame.concat(), wgpu::BufferUsages::UNIFORM);
        let frame = self.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("frame"),
            layout: &pipeline.get_bind_group_layout(0),
            entries: &[wgpu::BindGroupEntry {
                binding: 0,
                resource: frame.as_entire_binding(),
            }],
        });

        let color = self.target(COLOR_FORMAT);
        let depth = self.target(DEPTH_FORMAT);
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: &color.create_view(&Default::default()),
                depth_slice: None,
                resolve_target: None,
                ops: Default::default(),
            })],
            depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                view: &depth.create_view(&Default::default()),
                depth_ops: Some(Default::default()),
                stencil_ops: None,
            }),
            ..Default::default()
        });
        pass.set_pipeline(&pipeline);
        pass.set_bind_group(0, &frame, &[]);
        pass.set_bind_group(bindings.group(), bindings.bind_group(), &[]);
        pass.set_vertex_buffer(0, self.vertices.slice(..));
        pass.set_vertex_buffer(1, instances.slice(..));
        pass.draw(0..36, 0..self.render_from_cube.len() as u32);
        drop(pass);

        self.save(encoder, &color, path)
    }

    fn target(&self, format: wgpu::TextureFormat) -> wgpu::Texture {
        self.device.create_texture(&wgpu::TextureDescriptor {
            label: None,
            size: SIZE,
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format,
            usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::COPY_SRC,
            view_formats: &[],
        })
    }

    /// Submits, waits and writes the image.
    fn save(
        &self,
        mut encoder: wgpu::CommandEncoder,
        color: &wgpu::Texture,
        path: &Path,
    ) -> Result<(), Box<dyn Error>> {
        let row = 4 * SIZE.width;
        let pixels = self.device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("pixels"),
            size: u64::from(row * SIZE.height),
            usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
            mapped_at_creation: false,
        });
        // A copy needs rows of a multiple of 256 bytes, which those of 960 pixels are.
        let rows = wgpu::TexelCopyBufferInfo {
            buffer: &pixels,
            layout: wgpu::TexelCopyBufferLayout {
                offset: 0,
                bytes_per_row: Some(row),
                rows_per_image: None,
            },
        };
        encoder.copy_texture_to_buffer(color.as_image_copy(), rows, SIZE);
        self.queue.submit([encoder.finish()]);
        pixels.map_async(wgpu::MapMode::Read, .., |_| ());
        self.device.poll(wgpu::PollType::wait_indefinitely())?;

        if let Some(folder) = path.parent() {
            std::fs::create_dir_all(folder)?;
        }
        let bytes = pixels.get_mapped_range(..)?;
        image::save_buffer(
            path,
            &bytes,
            SIZE.width,
            SIZE.height,
            image::ColorType::Rgba8,
        )?;
        Ok(())
    }
}

fn buffer<T: bytemuck::NoUninit>(
    device: &wgpu::Device,
    contents: &[T],
    usage: wgpu::BufferUsages,
) -> wgpu::Buffer {
    device.create_buffer_init(&BufferInitDescriptor {
        label: None,
        contents: bytemuck::cast_slice(contents),
        usage,
    })
}

/// Returns two triangles for each side of the cube from -1 to 1, counter-clockwise as seen from
/// outside.
fn cube_corners() -> Vec<Vec3> {
    let sides = [
        Vec3::X,
        Vec3::Y,
        Vec3::Z,
        Vec3::NEG_X,
        Vec3::NEG_Y,
        Vec3::NEG_Z,
    ];
    let corners = [
        (-1.0, -1.0),
        (1.0, -1.0),
        (1.0, 1.0),
        (1.0, 1.0),
        (-1.0, 1.0),
        (-1.0, -1.0),
    ];
    let side = |out: Vec3| {
        let right = Vec3::new(out.y, out.z, out.x);
        corners.map(|(x, y)| out + right * x + out.cross(right) * y)
    };
    sides.into_iter().flat_map(side).collect()
}
