//! Shows an engine with its own bind groups: maps, uniform buffers and one sampler under its own
//! names, and of the library only the WGSL modules, called with these as arguments.
//!
//! `cargo run --example own_layout` draws a floor, a box and a ball under a sun and a point light
//! into `target/own_layout.png`. The parts to read are [`layout`], [`run`] and `own_layout.wgsl`;
//! the rest is the scene.

use std::error::Error;
use std::path::PathBuf;
use std::process::ExitCode;

use clap::Parser;
use example_support::camera::Camera;
use example_support::mesh::{Instance, Object, Vertex, cube, sphere, square};
use example_support::phong::{Batch, Lighting, Phong, PhongDescriptor, Picture};
use example_support::{arguments, picture};
use glam::{DVec3, Mat4, Vec3};
use shadow_support::gpu::{Gpu, GpuRequest};
use shadow_support::readback;
use wgpu_shadows::{
    CasterPipeline, Casters, Coverage, DirectionalLight, DirectionalShadow, MeshCaster, OmniLight,
    OmniShadow, ShadowCaster, ShadowFrameDescriptor, ShadowScene, caster::CasterPipelineDescriptor,
    caster::CasterVertex, caster::ModelTransform, caster::PositionAttribute, shader,
};

/// Draws a scene whose shadows are in the engine's own bind group.
#[derive(Parser)]
struct Arguments {
    /// Names the file for the image.
    #[arg(default_value = "target/own_layout.png")]
    file: PathBuf,
}

const SIZE: [u32; 2] = [960, 540];
const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8UnormSrgb;
const TOWARD_SUN: Vec3 = Vec3::new(0.5, 0.8, 0.45);
/// Is the point light, as in [`FRAGMENT`].
const LAMP: OmniLight = OmniLight {
    position_world: DVec3::new(-1.2, 1.6, 1.4),
    range: 9.0,
};

/// Adds the point light to `shade`, which is Blinn-Phong under the sun.
const FRAGMENT: &str = "
@fragment
fn fragment(surface: Surface) -> @location(0) vec4<f32> {
    let sun = shade(surface, sunlight(surface.position, surface.normal));
    let to_lamp = vec3<f32>(-1.2, 1.6, 1.4) - surface.position;
    let falloff = max(1.0 - length(to_lamp) / 9.0, 0.0);
    let facing = max(dot(surface.normal, normalize(to_lamp)), 0.0);
    let lamp = lamplight(surface.position, surface.normal) * facing * falloff * falloff;
    return vec4<f32>(sun + surface.albedo * vec3<f32>(1.2, 0.62, 0.25) * lamp, 1.0);
}
";

fn main() -> ExitCode {
    arguments::run("own_layout", run)
}

fn run(arguments: Arguments) -> Result<(), Box<dyn Error>> {
    let gpu = Gpu::new(&GpuRequest::default())?;
    let mut sun = DirectionalShadow::new(&gpu.device, &Default::default())?;
    let mut lamp = OmniShadow::new(&gpu.device, &Default::default())?;

    // This creates the library's WGSL, the engine's bindings and functions behind it, and a group
    // with what they name.
    let modules = shader::compose(&["bias_plane", "filter_tent3", "cube_face", "normal"])?;
    let layout = layout(&gpu.device);
    let sampler = gpu.device.create_sampler(&Default::default());
    let resources = [
        wgpu::BindingResource::Sampler(&sampler),
        wgpu::BindingResource::TextureView(sun.maps().texture_view()),
        sun.maps().uniform_buffer().as_entire_binding(),
        wgpu::BindingResource::TextureView(lamp.maps().texture_view()),
        lamp.maps().uniform_buffer().as_entire_binding(),
    ];
    let entries: Vec<_> = (0..)
        .zip(resources)
        .map(|(binding, resource)| wgpu::BindGroupEntry { binding, resource })
        .collect();
    let group = gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: Some("the engine's own"),
        layout: &layout,
        entries: &entries,
    });
    let phong = Phong::new(
        &gpu,
        &PhongDescriptor {
            visibility_wgsl: &(modules + include_str!("own_layout.wgsl")),
            fragment_wgsl: FRAGMENT,
            fragment_entry: "fragment",
            shadow_group: 1,
            shadow_layout: &layout,
            format: FORMAT,
            sample_count: 4,
        },
    );

    // Depth passes are recorded as usual, with one frame for both lights.
    let objects = objects(&gpu.device);
    let casters = casters(&gpu.device, &objects)?;
    let casters: Vec<&dyn ShadowCaster> = casters.iter().map(|caster| caster as _).collect();
    let camera = Camera::new(
        Vec3::new(1.0, 3.6, 7.0),
        Vec3::new(0.0, 0.5, 0.0),
        0.8,
        SIZE,
    );
    let mut scene = ShadowScene::new();
    let frame = scene.frame(&ShadowFrameDescriptor {
        origin: DVec3::ZERO,
        coverage: Coverage::Cameras(&[camera.view]),
        casters: Casters::List(&casters),
        receivers: &[],
    })?;
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    sun.record(&mut encoder, &frame, &DirectionalLight::new(-TOWARD_SUN))?;
    lamp.record(&mut encoder, &frame, &LAMP)?;

    let lighting = Lighting {
        light: TOWARD_SUN.normalize().extend(0.0),
        light_color: Vec3::new(0.50, 0.54, 0.60),
        light_range: f32::INFINITY,
        ambient: Vec3::splat(0.10),
        sky: Vec3::new(0.05, 0.07, 0.10),
    };
    let target = gpu.target(FORMAT, SIZE, 1);
    let view = Picture {
        camera: &camera,
        lighting: &lighting,
        shadows: &group,
        target: &target,
    };
    phong.draw(&gpu, &mut encoder, &view, objects.iter().map(Batch::from));
    let pixels = readback::texels(&gpu, encoder, &target)?;
    if let Some(folder) = arguments.file.parent() {
        picture::make_folder(folder)?;
    }
    picture::save(&arguments.file, &pixels, SIZE)?;
    println!("{}", arguments.file.display());
    Ok(())
}

/// Creates the layout of the engine's own bind group: a sampler, then map and uniforms of the sun,
/// then those of the point light.
fn layout(device: &wgpu::Device) -> wgpu::BindGroupLayout {
    let texture = wgpu::BindingType::Texture {
        sample_type: wgpu::TextureSampleType::Depth,
        view_dimension: wgpu::TextureViewDimension::D2Array,
        multisampled: false,
    };
    let uniform = wgpu::BindingType::Buffer {
        ty: wgpu::BufferBindingType::Uniform,
        has_dynamic_offset: false,
        min_binding_size: None,
    };
    let sampler = wgpu::BindingType::Sampler(wgpu::SamplerBindingType::NonFiltering);
    let entries: Vec<_> = (0..)
        .zip([sampler, texture, uniform, texture, uniform])
        .map(|(binding, ty)| wgpu::BindGroupLayoutEntry {
            binding,
            visibility: wgpu::ShaderStages::FRAGMENT,
            ty,
            count: None,
        })
        .collect();
    device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: Some("the engine's own"),
        entries: &entries,
    })
}

fn objects(device: &wgpu::Device) -> Vec<Object> {
    let place = |scale: f32, place: Vec3| {
        Mat4::from_translation(place) * Mat4::from_scale(Vec3::splat(scale))
    };
    let object = |mesh: &[Vertex], render_from_model, albedo: [f32; 3]| {
        let instance = Instance {
            render_from_model,
            albedo: albedo.into(),
            checker: 0.0,
        };
        Object::new(device, mesh, instance)
    };
    let grey = [0.70, 0.68, 0.64];
    vec![
        object(&square(Vec3::Y, 0.0), place(8.0, Vec3::ZERO), grey),
        object(
            &cube(),
            place(0.7, Vec3::new(0.6, 0.7, -0.4)),
            [0.72, 0.35, 0.28],
        ),
        object(
            &cube(),
            place(0.3, Vec3::new(-2.2, 0.3, 0.3)),
            [0.35, 0.55, 0.35],
        ),
        object(
            &sphere(32),
            place(0.5, Vec3::new(-0.9, 0.5, 0.2)),
            [0.32, 0.45, 0.72],
        ),
    ]
}

fn casters(
    device: &wgpu::Device,
    objects: &[Object],
) -> Result<Vec<MeshCaster>, wgpu_shadows::error::CasterError> {
    let pipeline = CasterPipeline::new(
        device,
        &CasterPipelineDescriptor {
            vertex: CasterVertex::BuiltIn {
                position: PositionAttribute::float32x3(size_of::<Vertex>() as u64),
                model: ModelTransform::INSTANCE_MATRIX,
            },
            ..Default::default()
        },
    )?;
    let casters = objects
        .iter()
        .map(|object| object.caster(device, &pipeline));
    casters.collect()
}
