//! Tests that an engine with its own bindings, such as `examples/own_layout.rs`, gets the same
//! visibilities as from `ShadowBindings`, to the bit.

use glam::{DVec3, Vec3};
use shadow_support::bind;
use shadow_support::camera::Camera;
use shadow_support::mesh::Mesh;
use shadow_support::probe::{Point, PointShader};
use shadow_support::random::Random;
use wgpu_shadows::{
    CascadeLayout, DirectionalLight, DirectionalShadow, DirectionalShadowDescriptor, OmniLight,
    OmniShadow, OmniShadowDescriptor, shader,
};

use crate::fixtures::ask::{Ask, record_omni};
use crate::fixtures::frames::{Coverage, DirectionalFrame, OmniFrame};
use crate::fixtures::gpu::{Gpu, gpu};
use crate::fixtures::probe::record;
use crate::fixtures::scene::Scene;
use crate::fixtures::wgsl;

const MODULES: [&str; 4] = ["bias_plane", "filter_tent3", "cube_face", "normal"];

/// Returns the modules, followed by the engine's own text.
fn composition() -> String {
    let modules = shader::compose(&MODULES).expect("modules of the table");
    modules + include_str!("../../examples/own_layout.wgsl")
}

/// Creates the engine's bind group.
fn own_group(
    gpu: &Gpu,
    sun: &DirectionalShadow,
    lamp: &OmniShadow,
) -> (wgpu::BindGroupLayout, wgpu::BindGroup) {
    let texture = bind::depth_texture(wgpu::TextureViewDimension::D2Array);
    let sampler = wgpu::BindingType::Sampler(wgpu::SamplerBindingType::NonFiltering);
    let types = [sampler, texture, bind::UNIFORM, texture, bind::UNIFORM];
    let layout = bind::layout(gpu, wgpu::ShaderStages::COMPUTE, &types);
    let sampler = gpu.device.create_sampler(&Default::default());
    let resources = [
        wgpu::BindingResource::Sampler(&sampler),
        wgpu::BindingResource::TextureView(sun.maps().texture_view()),
        sun.maps().uniform_buffer().as_entire_binding(),
        wgpu::BindingResource::TextureView(lamp.maps().texture_view()),
        lamp.maps().uniform_buffer().as_entire_binding(),
    ];
    let group = bind::group(gpu, &layout, &resources);
    (layout, group)
}

#[test]
fn the_composition_declares_only_the_engines_bindings() {
    let module = wgsl::validate(&composition()).expect("valid WGSL");
    let mut bound: Vec<_> = module
        .global_variables
        .iter()
        .filter(|(_, variable)| variable.binding.is_some())
        .filter_map(|(_, variable)| variable.name.clone())
        .collect();
    bound.sort();
    let own = [
        "depth_sampler",
        "lamp_depths",
        "lamp_views",
        "sun_depths",
        "sun_view",
    ];
    assert_eq!(bound, own);
}

#[test]
fn own_bindings_give_the_same_bits() {
    let gpu = gpu();
    let scene = Scene::new(
        gpu,
        &[
            Mesh::floor(0.0, 6.0),
            Mesh::cuboid(Vec3::new(-1.5, 0.0, -1.0), Vec3::new(-0.3, 1.6, 0.4)),
            Mesh::sphere(Vec3::new(1.4, 1.0, 0.6), 0.7, 12),
        ],
    );
    let list = scene.list();
    let descriptor = DirectionalShadowDescriptor {
        map_size: 256,
        fade: 0.5,
        layout: CascadeLayout::fixed(1),
        ..Default::default()
    };
    let mut sun = DirectionalShadow::new(&gpu.device, &descriptor).expect("a valid sun");
    let camera = Camera::modern(DVec3::new(2.0, 6.0, 8.0), DVec3::ZERO, 0.9, 1.5);
    let frame = DirectionalFrame {
        origin: DVec3::ZERO,
        light: DirectionalLight::new(Vec3::new(0.6, -1.0, 0.3)),
        coverage: Coverage::Camera(camera.view().with_max_distance(12.0)),
        casters: &list,
        receivers: &[],
    };
    record(gpu, &mut sun, &frame);
    let descriptor = OmniShadowDescriptor {
        map_size: 128,
        ..Default::default()
    };
    let mut lamp = OmniShadow::new(&gpu.device, &descriptor).expect("a valid lamp");
    let frame = OmniFrame {
        origin: DVec3::ZERO,
        light: OmniLight {
            position_world: DVec3::new(0.2, 2.6, 0.1),
            range: 9.0,
        },
        camera: None,
        casters: &list,
        receivers: &[],
    };
    record_omni(gpu, &mut lamp, &frame).expect("a valid frame");

    let mut random = Random::new(79);
    let points: Vec<_> = (0..8000)
        .map(|index| {
            // Half of the points lie on the floor, and some anywhere, also outside the maps.
            let among = if index % 2 == 0 {
                2
            } else {
                scene.triangles.len()
            };
            let triangle = scene.triangles[random.index(among)];
            let place = match index % 10 {
                9 => random.point(DVec3::splat(-15.0), DVec3::splat(15.0)),
                _ => triangle.point(random.unit(), random.unit()),
            };
            Point::rounded(place, triangle.normal())
        })
        .collect();
    let (layout, group) = own_group(gpu, &sun, &lamp);
    let lights = [("sun", sun.maps()), ("lamp", lamp.maps())];
    for (own, given) in [("sunlight", "shadow_sun"), ("lamplight", "shadow_lamp")] {
        let call = |function| format!("{function}(point.position, point.normal)");
        let own = PointShader::new(gpu, &composition(), "f32", &call(own), &layout);
        let own: Vec<f32> = own.ask(gpu, &group, &points);
        let wanted = Ask::new(gpu, &lights, &call(given)).points(gpu, &points);
        let dark = wanted.iter().filter(|seen| **seen < 0.5).count();
        let partial = wanted
            .iter()
            .filter(|seen| (0.01..0.99).contains(*seen))
            .count();
        assert!(
            dark > 500 && partial > 50,
            "{given}: {dark} dark, {partial} partial"
        );
        let differ = own
            .iter()
            .zip(&wanted)
            .filter(|(own, wanted)| own.to_bits() != wanted.to_bits())
            .count();
        assert_eq!(differ, 0, "{given}");
    }
}
