//! Tests meshes that are mirrored, open, wound the other way, or full of triangles without area.

use glam::{DVec3, Mat4, Vec3};
use shadow_support::mesh::Mesh;
use shadow_support::readback;
use wgpu_shadows::{
    Aabb, CasterPipeline, DirectionalLight, ShadowCaster, caster::CasterPipelineDescriptor,
};

use super::stage::Sun;
use super::table;
use crate::fixtures::frames::Coverage;
use crate::fixtures::gpu::gpu;
use crate::fixtures::rounding::U;

/// Is the number of texels per side of the map.
const SIZE: usize = 96;

/// Returns the depths of a mesh alone, under a slanted light.
fn depths(pipeline: &CasterPipeline, mesh: &Mesh, transform: Mat4) -> Vec<f32> {
    let gpu = gpu();
    let mut sun = Sun::of_size(SIZE as u32);
    let caster = mesh.caster(gpu, pipeline, transform);
    let casters: [&dyn ShadowCaster; 1] = [&caster];
    let light = DirectionalLight::new(Vec3::new(0.4, -1.0, 0.3));
    let cover = Aabb::new(Vec3::splat(-2.0), Vec3::splat(2.0));
    sun.record(DVec3::ZERO, light, Coverage::Bounds(cover), &casters, &[]);
    let depths = readback::depth_layer(gpu, sun.shadow.maps().texture(), 0);
    assert!(depths.iter().filter(|depth| **depth > 0.0).count() > 100);
    depths
}

fn pipeline(cull: Option<wgpu::Face>) -> CasterPipeline {
    let descriptor = CasterPipelineDescriptor {
        primitive: wgpu::PrimitiveState {
            cull_mode: cull,
            ..Default::default()
        },
        ..CasterPipelineDescriptor::new()
    };
    CasterPipeline::new(&gpu().device, &descriptor).expect("a valid pipeline")
}

fn reversed(mesh: &Mesh) -> Mesh {
    let mut mesh = mesh.clone();
    for triangle in mesh.indices.chunks_mut(3) {
        triangle.swap(1, 2);
    }
    mesh
}

/// Returns the mesh negated along x, so that a transform that mirrors x gives the mesh itself,
/// exactly.
fn mirrored(mesh: &Mesh) -> Mesh {
    let mut mesh = mesh.clone();
    for position in &mut mesh.positions {
        position.x = -position.x;
    }
    reversed(&mesh)
}

/// Returns the mesh with points, needles and folded triangles added, which cover no area.
fn with_empty_triangles(mesh: &Mesh) -> Mesh {
    let mut mesh = mesh.clone();
    let first = mesh.positions.len() as u32;
    let far = Vec3::new(1.7, 1.1, -1.3);
    mesh.positions.extend([
        far,
        far * 0.5,
        Vec3::ZERO,
        far * 0.25,
        Vec3::new(1.0, 1.5, -1.7),
    ]);
    let triangles = [[0, 0, 0], [0, 0, 1], [0, 1, 2], [2, 0, 3], [4, 4, 4]];
    let indices = triangles.as_flattened().iter();
    mesh.indices.extend(indices.map(|corner| first + corner));
    mesh
}

/// Returns the largest change of depth from a texel to one of its four neighbours, among those that
/// are drawn.
fn steepness(depths: &[f32], texel: usize) -> f64 {
    let (x, y) = (texel % SIZE, texel / SIZE);
    let beside = [
        (x > 0, 1, 0),
        (x + 1 < SIZE, 0, 1),
        (y > 0, SIZE, 0),
        (y + 1 < SIZE, 0, SIZE),
    ];
    beside
        .into_iter()
        .filter(|(inside, ..)| *inside)
        .map(|(_, back, on)| depths[texel + on - back])
        .filter(|other| *other > 0.0)
        .map(|other| f64::from((other - depths[texel]).abs()))
        .fold(0.0, f64::max)
}

/// The order of a triangle's corners and an exact mirroring change no depth except by rounding,
/// since interpolation may start from another corner: by no more than the derived bias allows for,
/// 6u of the depth range and the change of depth over `6uN` texels. Triangles without area draw
/// nothing, and not one texel is drawn more or less.
#[test]
fn winding_mirroring_and_empty_triangles_change_nothing() {
    let solid = Mesh::sphere(Vec3::new(0.1, 0.2, -0.1), 1.1, 12);
    let open = Mesh::sheet(
        Vec3::new(-1.0, 0.3, -1.1),
        Vec3::new(0.3, 0.4, 2.0),
        Vec3::new(2.0, 0.1, -0.2),
    );
    let mirror = Mat4::from_scale(Vec3::new(-1.0, 1.0, 1.0));
    let mut worst: f64 = 0.0;
    let mut assert_same = |name: &str, wanted: &[f32], found: &[f32]| {
        for (texel, (a, b)) in wanted.iter().zip(found).enumerate() {
            assert_eq!(*a == 0.0, *b == 0.0, "{name}: a stray or missing texel");
            let error = f64::from((a - b).abs()) / U;
            let allowed = 6.0 + 6.0 * SIZE as f64 * steepness(wanted, texel);
            worst = worst.max(error / allowed);
            let machine = gpu().describe();
            assert!(
                error <= allowed,
                "{name} on {machine}: {error} of {allowed} u"
            );
        }
    };
    for (name, mesh) in [("solid", &solid), ("open", &open)] {
        let both = pipeline(None);
        let plain = depths(&both, mesh, Mat4::IDENTITY);
        let turned = depths(&both, &reversed(mesh), Mat4::IDENTITY);
        assert_same(&format!("{name} wound the other way"), &plain, &turned);
        let seen = depths(&both, &mirrored(mesh), mirror);
        assert_same(&format!("{name} mirrored"), &plain, &seen);
        let seen = depths(&both, &with_empty_triangles(mesh), Mat4::IDENTITY);
        assert_same(&format!("{name} with empty triangles"), &plain, &seen);
    }
    for cull in [wgpu::Face::Back, wgpu::Face::Front] {
        let one = pipeline(Some(cull));
        let plain = depths(&one, &solid, Mat4::IDENTITY);
        let seen = depths(&one, &mirrored(&solid), mirror);
        assert_same(&format!("mirrored, {cull:?} culled"), &plain, &seen);
    }
    table::record(
        "mirrored, single-sided and reversed meshes, triangles without area",
        "no stray texel, depths within 6u and the slope over 6uN texels",
        format!("0 stray texels, {worst:.2} of what is allowed"),
    );
}
