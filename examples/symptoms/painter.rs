//! Draws one image.

use std::error::Error;

use example_support::camera::Camera;
use example_support::mesh::{Instance, Object, Vertex};
use example_support::phong::{Batch, Lighting, Phong, PhongDescriptor, Picture};
use example_support::textbook;
use glam::{DVec3, Mat4, Vec3};
use shadow_support::gpu::Gpu;
use shadow_support::readback;
use wgpu_shadows::{
    CasterPipeline, Casters, Coverage, DirectionalLight, DirectionalShadow,
    DirectionalShadowDescriptor, MeshCaster, ShadowBindings, ShadowBindingsDescriptor,
    ShadowCaster, ShadowFrameDescriptor, ShadowScene, caster::CasterPipelineDescriptor,
    caster::CasterVertex, caster::ModelTransform, caster::PositionAttribute,
};

use crate::props::Prop;

/// Is the width and height of the images.
pub const SIZE: [u32; 2] = [212, 144];

/// Describes an image.
#[derive(Clone)]
pub struct Setup {
    pub props: Vec<Prop>,
    pub shadow: DirectionalShadowDescriptor<'static>,
    /// Is WGSL for the visibility of `surface`, whose geometric normal is `normal`.
    pub visibility: &'static str,
    /// Is the direction that the library is told.
    pub direction: Vec3,
    pub toward_sun: Vec3,
    pub eye: Vec3,
    pub target: Vec3,
    pub max_distance: f32,
    pub cull: Option<wgpu::Face>,
    /// Is where the scene lies in the world.
    pub place_world: DVec3,
    /// Is the origin of render space in the world.
    pub origin: DVec3,
}

impl Setup {
    /// Describes the textbook's scene, as it is right.
    pub fn of(props: Vec<Prop>) -> Self {
        Self {
            props,
            shadow: DirectionalShadowDescriptor::default(),
            visibility: "shadow_sun(surface.position, normal)",
            direction: -textbook::TOWARD_SUN,
            toward_sun: textbook::TOWARD_SUN.normalize(),
            eye: textbook::EYE,
            target: textbook::TARGET,
            max_distance: f32::INFINITY,
            cull: None,
            place_world: DVec3::ZERO,
            origin: DVec3::ZERO,
        }
    }
}

/// Draws an image: four bytes a pixel.
pub fn paint(gpu: &Gpu, setup: &Setup) -> Result<Vec<u8>, Box<dyn Error>> {
    // The engine's numbers are 32 bits wide, as far from the origin as they are.
    let place = (setup.place_world - setup.origin).as_vec3();
    let camera = Camera::new(
        setup.eye + place,
        setup.target + place,
        textbook::FIELD_OF_VIEW_RADIANS,
        SIZE,
    );
    let moved = |prop: &Prop, by: Vec3| Instance {
        render_from_model: Mat4::from_translation(place + by) * prop.instance.render_from_model,
        ..prop.instance
    };
    let device = &gpu.device;
    let pipeline = CasterPipeline::new(
        device,
        &CasterPipelineDescriptor {
            vertex: CasterVertex::BuiltIn {
                position: PositionAttribute::float32x3(size_of::<Vertex>() as u64),
                model: ModelTransform::INSTANCE_MATRIX,
            },
            primitive: wgpu::PrimitiveState {
                cull_mode: setup.cull,
                ..Default::default()
            },
            ..Default::default()
        },
    )?;
    let casting = setup.props.iter().filter(|prop| prop.casts);
    let meshes: Vec<MeshCaster> = casting
        .map(|prop| {
            let instance = moved(prop, prop.caster_offset);
            Object::new(device, &prop.mesh, instance).caster(device, &pipeline)
        })
        .collect::<Result<_, _>>()?;
    let casters: Vec<&dyn ShadowCaster> = meshes.iter().map(|mesh| mesh as _).collect();

    let mut sun = DirectionalShadow::new(device, &setup.shadow)?;
    let mut scene = ShadowScene::new();
    let cameras = [camera.view.with_max_distance(setup.max_distance)];
    let frame = scene.frame(&ShadowFrameDescriptor {
        origin: setup.origin,
        coverage: Coverage::Cameras(&cameras),
        casters: Casters::List(&casters),
        receivers: &[],
    })?;
    let mut encoder = gpu.encoder();
    sun.record(
        &mut encoder,
        &frame,
        &DirectionalLight::new(setup.direction),
    )?;

    let bindings = ShadowBindings::new(
        device,
        &ShadowBindingsDescriptor {
            lights: &[("sun", sun.maps())],
            ..Default::default()
        },
    )?;
    let fragment = format!(
        "@fragment
        fn fragment(surface: Surface) -> @location(0) vec4<f32> {{
            let normal = shadow_geometric_normal(surface.position, frame.eye - surface.position);
            let visibility = {};
            return vec4<f32>(shade(surface, visibility), 1.0);
        }}",
        setup.visibility
    );
    let phong = Phong::new(
        gpu,
        &PhongDescriptor {
            visibility_wgsl: bindings.wgsl(),
            fragment_wgsl: &fragment,
            fragment_entry: "fragment",
            shadow_group: bindings.group(),
            shadow_layout: bindings.layout(),
            format: wgpu::TextureFormat::Rgba8UnormSrgb,
            sample_count: 4,
        },
    );
    let drawn = setup.props.iter().filter(|prop| prop.is_drawn);
    let objects: Vec<Object> = drawn
        .map(|prop| Object::new(device, &prop.mesh, moved(prop, Vec3::ZERO)))
        .collect();
    let target = gpu.target(wgpu::TextureFormat::Rgba8UnormSrgb, SIZE, 1);
    phong.draw(
        gpu,
        &mut encoder,
        &Picture {
            camera: &camera,
            lighting: &Lighting {
                light: setup.toward_sun.extend(0.0),
                light_color: Vec3::ONE,
                light_range: f32::INFINITY,
                ambient: Vec3::splat(0.2),
                sky: Vec3::new(0.45, 0.55, 0.70),
            },
            shadows: bindings.bind_group(),
            target: &target,
        },
        objects.iter().map(Batch::from),
    );
    Ok(readback::texels(gpu, encoder, &target)?)
}
