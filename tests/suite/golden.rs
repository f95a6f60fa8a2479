//! Compares a small scene through an engine's own shader, and a map as `DebugView` draws it, with
//! reference images.

use glam::{DVec3, Vec3};
use image::RgbaImage;
use shadow_support::bind;
use shadow_support::camera::Camera;
use shadow_support::mesh::Mesh;
use shadow_support::readback;
use wgpu_shadows::{
    Aabb, Bias, CameraView, CascadeLayout, DirectionalLight, DirectionalShadow,
    DirectionalShadowDescriptor, Filter, ShadowBindings, ShadowBindingsDescriptor,
    debug::DebugImage, debug::DebugView,
};

use crate::fixtures::frames::{Coverage, DirectionalFrame};
use crate::fixtures::golden::{Limits, assert_golden};
use crate::fixtures::gpu::{Gpu, gpu};
use crate::fixtures::picture::{
    COLOR, color_pass, color_target, depth_target, scene_pass, scene_pipeline,
};
use crate::fixtures::probe::record;
use crate::fixtures::scene::Scene;

const SIZE: u32 = 128;
const LIGHT: Vec3 = Vec3::new(-1.1, -1.0, 0.2);

/// Allows one in a thousand pixels to lie on an edge that another driver draws elsewhere.
const LIMITS: Limits = Limits {
    channel: 3,
    failed_pixels: 16,
    mean: 0.1,
};

/// Computes Blinn-Phong with the library's visibility and its geometric normal.
const SHADING: &str = "
struct Eye {
    clip_from_render: mat4x4<f32>,
    position: vec3<f32>,
    light: vec3<f32>,
}
@group(0) @binding(0) var<uniform> eye: Eye;

struct Varying {
    @builtin(position) clip: vec4<f32>,
    @location(0) position: vec3<f32>,
    @location(1) color: vec3<f32>,
}

@vertex
fn vertex(@location(0) position: vec3<f32>, @location(1) color: vec3<f32>) -> Varying {
    return Varying(eye.clip_from_render * vec4<f32>(position, 1.0), position, color);
}

@fragment
fn fragment(in: Varying) -> @location(0) vec4<f32> {
    let normal = shadow_geometric_normal(in.position, eye.position - in.position);
    let toward_light = -normalize(eye.light);
    let toward_eye = normalize(eye.position - in.position);
    let facing = max(dot(normal, toward_light), 0.0);
    let half_way = normalize(toward_light + toward_eye);
    let shine = pow(max(dot(normal, half_way), 0.0), 32.0);
    let lit = shadow_sun(in.position, normal) * step(1e-4, facing);
    let ambient = 0.12 + 0.06 * normal.y;
    let color = in.color * (ambient + 0.85 * lit * facing) + 0.25 * lit * shine;
    return vec4<f32>(sqrt(clamp(color, vec3<f32>(0.0), vec3<f32>(1.0))), 1.0);
}
";

/// Returns meshes and their colours: a floor, a box, a ball, a thin leaning board, and a post that
/// casts a long thin shadow.
fn meshes() -> Vec<(Mesh, Vec3)> {
    let board = Mesh::sheet(
        Vec3::new(-1.6, 0.0, 1.6),
        Vec3::new(1.8, 0.0, 0.9),
        Vec3::new(-0.3, 1.5, -0.5),
    );
    vec![
        (Mesh::floor(0.0, 6.0), Vec3::new(0.75, 0.72, 0.65)),
        (
            Mesh::cuboid(Vec3::new(-1.0, 0.0, -1.6), Vec3::new(0.3, 1.4, -0.4)),
            Vec3::new(0.7, 0.25, 0.2),
        ),
        (
            Mesh::sphere(Vec3::new(1.5, 0.9, 0.4), 0.9, 24),
            Vec3::new(0.25, 0.45, 0.75),
        ),
        (board, Vec3::new(0.3, 0.6, 0.3)),
        (
            Mesh::cuboid(Vec3::new(2.6, 0.0, -2.1), Vec3::new(2.75, 3.0, -1.95)),
            Vec3::new(0.6, 0.55, 0.2),
        ),
    ]
}

fn camera() -> Camera {
    Camera::modern(
        DVec3::new(1.2, 5.4, 7.6),
        DVec3::new(-0.3, 0.3, -0.2),
        0.78,
        1.0,
    )
}

fn scene() -> Scene {
    let meshes: Vec<_> = meshes().into_iter().map(|(mesh, _)| mesh).collect();
    Scene::new(gpu(), &meshes)
}

fn sun(
    gpu: &Gpu,
    scene: &Scene,
    descriptor: &DirectionalShadowDescriptor<'_>,
    coverage: Coverage,
) -> DirectionalShadow {
    let mut shadow = DirectionalShadow::new(&gpu.device, descriptor).expect("a valid sun");
    let frame = DirectionalFrame {
        origin: DVec3::ZERO,
        light: DirectionalLight::new(LIGHT),
        coverage,
        casters: &scene.list(),
        receivers: &[],
    };
    record(gpu, &mut shadow, &frame);
    shadow
}

/// Draws the scene as an engine would.
fn picture(gpu: &Gpu, shadow: &DirectionalShadow) -> RgbaImage {
    let bindings = ShadowBindings::new(
        &gpu.device,
        &ShadowBindingsDescriptor {
            lights: &[("sun", shadow.maps())],
            ..Default::default()
        },
    )
    .expect("valid bindings");
    // The image's depth is not reversed, so that confusing it with the map's would show.
    let camera = Camera {
        reversed: false,
        ..camera()
    };
    let CameraView {
        view_from_render,
        clip_from_view,
        ..
    } = camera.view();
    let eye: Vec<f32> = (clip_from_view * view_from_render)
        .to_cols_array()
        .into_iter()
        .chain(camera.pose.eye.as_vec3().extend(0.0).to_array())
        .chain(LIGHT.extend(0.0).to_array())
        .collect();
    let mut vertices: Vec<[Vec3; 2]> = Vec::new();
    for (mesh, color) in meshes() {
        let corners = mesh
            .indices
            .iter()
            .map(|index| mesh.positions[*index as usize]);
        vertices.extend(corners.map(|corner| [corner, color]));
    }
    let vertices: Vec<f32> = vertices
        .iter()
        .flatten()
        .flat_map(|v| v.to_array())
        .collect();
    let vertex_buffer = gpu.buffer(&vertices, wgpu::BufferUsages::VERTEX);
    let eye_buffer = gpu.buffer(&eye, wgpu::BufferUsages::UNIFORM);
    let (pipeline, group_0) = shading(gpu, &bindings, &eye_buffer);
    let (target, depth) = (color_target(gpu, SIZE), depth_target(gpu, SIZE));
    let mut encoder = gpu.encoder();
    {
        let mut pass = scene_pass(&mut encoder, &target, &depth);
        pass.set_pipeline(&pipeline);
        pass.set_bind_group(0, &group_0, &[]);
        pass.set_bind_group(bindings.group(), bindings.bind_group(), &[]);
        pass.set_vertex_buffer(0, vertex_buffer.slice(..));
        pass.draw(0..vertices.len() as u32 / 6, 0..1);
    }
    gpu.submit(encoder);
    readback::rgba8(gpu, &target)
}

fn shading(
    gpu: &Gpu,
    bindings: &ShadowBindings,
    eye: &wgpu::Buffer,
) -> (wgpu::RenderPipeline, wgpu::BindGroup) {
    let layout = bind::layout(gpu, wgpu::ShaderStages::VERTEX_FRAGMENT, &[bind::UNIFORM]);
    let group = bind::group(gpu, &layout, &[eye.as_entire_binding()]);
    let source = format!("{}{SHADING}", bindings.wgsl());
    let layouts = [Some(&layout), Some(bindings.layout())];
    let attributes = wgpu::vertex_attr_array![0 => Float32x3, 1 => Float32x3];
    let pipeline = scene_pipeline(gpu, &source, &layouts, 24, &attributes);
    (pipeline, group)
}

#[test]
fn a_scene_with_the_defaults() {
    let (gpu, scene) = (gpu(), scene());
    let descriptor = DirectionalShadowDescriptor {
        map_size: 512,
        layout: CascadeLayout::fixed(1),
        ..Default::default()
    };
    let shadow = sun(gpu, &scene, &descriptor, Coverage::Camera(camera().view()));
    assert_golden(gpu, "scene_default", &picture(gpu, &shadow), &LIMITS);
}

/// The scene has one map over all of it, a box filter, and a bias that was tuned by hand.
#[test]
fn a_scene_by_the_textbook() {
    let (gpu, scene) = (gpu(), scene());
    let descriptor = DirectionalShadowDescriptor {
        map_size: 512,
        filter: Filter::Box,
        bias: Bias::Manual {
            constant: 0.05,
            slope: 0.2,
        },
        layout: CascadeLayout::fixed(1),
        ..Default::default()
    };
    let whole = Aabb::new(Vec3::new(-6.0, 0.0, -6.0), Vec3::new(6.0, 3.0, 6.0));
    let shadow = sun(gpu, &scene, &descriptor, Coverage::Bounds(whole));
    assert_golden(gpu, "scene_textbook", &picture(gpu, &shadow), &LIMITS);
}

#[test]
fn a_map_as_a_picture() {
    let (gpu, scene) = (gpu(), scene());
    let descriptor = DirectionalShadowDescriptor {
        map_size: 128,
        layout: CascadeLayout::fixed(1),
        ..Default::default()
    };
    let shadow = sun(gpu, &scene, &descriptor, Coverage::Camera(camera().view()));
    let view = DebugView::new(&gpu.device, COLOR).expect("a renderable format");
    let target = color_target(gpu, SIZE);
    let mut encoder = gpu.encoder();
    {
        let mut pass = color_pass(&mut encoder, &target);
        view.draw(&mut pass, shadow.maps(), DebugImage::Layer(0))
            .expect("a layer of the map");
    }
    gpu.submit(encoder);
    let picture = readback::rgba8(gpu, &target);
    // Each texel is one pixel, whose grey level is the map's depth.
    let depths = readback::depth_layer(gpu, shadow.maps().texture(), 0);
    for (pixel, depth) in picture.pixels().zip(depths) {
        let error = f32::from(pixel.0[0]) - 255.0 * (1.0 - depth);
        assert!(error.abs() <= 0.51, "{pixel:?} for depth {depth}");
    }
    assert_golden(gpu, "debug_map", &picture, &LIMITS);
}
