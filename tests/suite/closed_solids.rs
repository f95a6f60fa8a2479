//! Tests which meshes are closed solids, and that the back faces of these make no difference to any
//! map.

use glam::{DVec3, Mat4, Quat, Vec3};
use shadow_support::mesh::Mesh;
use shadow_support::random::Random;
use shadow_support::readback;
use wgpu_shadows::{
    CascadeLayout, CasterPipeline, DirectionalLight, DirectionalShadow,
    DirectionalShadowDescriptor, OmniLight, OmniShadow, OmniShadowDescriptor, ShadowCaster,
    caster::CasterPipelineDescriptor, caster::is_closed_solid,
};

use crate::fixtures::frames::{Coverage, DirectionalFrame, OmniFrame, RecordFrame};
use crate::fixtures::gpu::{Gpu, gpu};

fn is_closed(mesh: &Mesh) -> bool {
    is_closed_solid(&mesh.positions, &mesh.indices)
}

fn joined(a: &Mesh, b: &Mesh) -> Mesh {
    let offset = a.positions.len() as u32;
    let more = b.indices.iter().map(|index| index + offset);
    Mesh {
        positions: [&a.positions[..], &b.positions].concat(),
        indices: a.indices.iter().copied().chain(more).collect(),
    }
}

fn inside_out(mesh: &Mesh) -> Mesh {
    let mut turned = mesh.clone();
    turned
        .indices
        .chunks_mut(3)
        .for_each(|corners| corners.swap(1, 2));
    turned
}

#[test]
fn solids_are_told_from_all_else() {
    let cube = Mesh::cuboid(Vec3::new(-1.0, 0.0, 2.0), Vec3::new(1.0, 1.5, 3.0));
    let ball = Mesh::sphere(Vec3::new(5.0, 1.0, 0.0), 0.7, 8);
    let sheet = Mesh::floor(0.0, 4.0);
    assert!(is_closed(&cube) && is_closed(&ball) && is_closed(&joined(&cube, &ball)));
    assert!(!is_closed(&sheet) && !is_closed(&joined(&cube, &sheet)));
    assert!(!is_closed(&inside_out(&cube)) && !is_closed(&joined(&ball, &inside_out(&cube))));
    assert!(!is_closed(&Mesh::default()));
    let mut open = cube.clone();
    open.indices.truncate(33);
    assert!(!is_closed(&open), "a triangle is missing");
    let mut turned = cube.clone();
    turned.indices.swap(0, 1);
    assert!(!is_closed(&turned), "a triangle is turned over");
    // The ball's seam is open by the rounding of its sines, which is small enough to count as
    // closed; a gap of a thousandth of the ball is not.
    let seam = ball.positions.iter().filter(|p| p.z.abs() < 1e-6).count();
    assert!(seam > 8);
    let mut split = ball.clone();
    for position in split.positions.iter_mut().skip(16).step_by(17) {
        position.z += 1e-3;
    }
    assert!(!is_closed(&split), "a seam gapes");
    let mut wild = cube.clone();
    wild.indices[4] = 8;
    assert!(!is_closed(&wild), "an index beyond the corners");
    // Separate corners for every face, as for flat shading, and triangles without area change
    // nothing.
    let flat = Mesh {
        positions: cube
            .indices
            .iter()
            .map(|&i| cube.positions[i as usize])
            .collect(),
        indices: (0..36).chain([3, 3, 7]).collect(),
    };
    assert!(is_closed(&flat));
    // A distant position and the two signs of zero change nothing either; numbers that are not
    // finite change only the result.
    let far = |mesh: &Mesh, shift: Vec3| Mesh {
        positions: mesh.positions.iter().map(|p| *p + shift).collect(),
        indices: mesh.indices.clone(),
    };
    assert!(is_closed(&far(&cube, Vec3::splat(4e5))));
    let mut signed = flat.clone();
    for position in signed.positions.iter_mut().step_by(2) {
        position.y = if position.y == 0.0 { -0.0 } else { position.y };
    }
    assert!(is_closed(&signed));
    assert!(!is_closed(&far(&cube, Vec3::new(f32::NAN, 0.0, 0.0))));
}

fn pipeline(gpu: &Gpu, cull: Option<wgpu::Face>) -> CasterPipeline {
    CasterPipeline::new(
        &gpu.device,
        &CasterPipelineDescriptor {
            primitive: wgpu::PrimitiveState {
                cull_mode: cull,
                ..Default::default()
            },
            ..Default::default()
        },
    )
    .expect("a valid pipeline")
}

/// Rotated, stretched and mirrored solids above each other are drawn with and without their back
/// faces: the maps of a sun and of a point light are the same, bit for bit.
#[test]
fn back_faces_of_solids_change_no_map() {
    let gpu = gpu();
    let mut random = Random::new(77);
    let solids: Vec<_> = (0..24)
        .map(|index| {
            let mesh = if index % 2 == 0 {
                Mesh::cuboid(Vec3::splat(-0.5), Vec3::splat(0.5))
            } else {
                Mesh::sphere(Vec3::ZERO, 0.6, 9)
            };
            assert!(is_closed(&mesh));
            let place = random.point(DVec3::new(-4.0, 0.0, -4.0), DVec3::new(4.0, 4.0, 4.0));
            let axis = random.direction().as_vec3();
            let size = random.point(DVec3::splat(0.2), DVec3::splat(1.6)).as_vec3();
            let mirror = if index % 5 == 0 {
                Vec3::new(-1.0, 1.0, 1.0)
            } else {
                Vec3::ONE
            };
            let turn = Quat::from_axis_angle(axis, random.range(0.0, 6.0) as f32);
            let matrix =
                Mat4::from_scale_rotation_translation(size * mirror, turn, place.as_vec3());
            (mesh, matrix)
        })
        .collect();
    let maps = [None, Some(wgpu::Face::Back)].map(|cull| {
        let pipeline = pipeline(gpu, cull);
        let casters: Vec<_> = solids
            .iter()
            .map(|(mesh, matrix)| mesh.caster(gpu, &pipeline, *matrix))
            .collect();
        let list: Vec<_> = casters
            .iter()
            .map(|caster| caster as &dyn ShadowCaster)
            .collect();
        let bounds = list
            .iter()
            .fold(wgpu_shadows::Aabb::EMPTY, |all, c| all.union(c.bounds()));
        let sun = DirectionalShadowDescriptor {
            map_size: 256,
            layout: CascadeLayout::fixed(1),
            ..Default::default()
        };
        let mut sun = DirectionalShadow::new(&gpu.device, &sun).expect("a valid sun");
        let lamp = OmniShadowDescriptor {
            map_size: 128,
            ..Default::default()
        };
        let mut lamp = OmniShadow::new(&gpu.device, &lamp).expect("a valid lamp");
        let mut encoder = gpu.encoder();
        let frame = DirectionalFrame {
            origin: DVec3::ZERO,
            light: DirectionalLight::new(Vec3::new(0.3, -1.0, 0.45)),
            coverage: Coverage::Bounds(bounds),
            casters: &list,
            receivers: &[],
        };
        sun.record_frame(&mut encoder, &frame)
            .expect("a valid frame");
        let frame = OmniFrame {
            origin: DVec3::ZERO,
            light: OmniLight {
                position_world: DVec3::new(0.3, 9.0, -0.2),
                range: 30.0,
            },
            camera: None,
            casters: &list,
            receivers: &[],
        };
        lamp.record_frame(&mut encoder, &frame)
            .expect("a valid frame");
        gpu.submit(encoder);
        let mut layers = vec![readback::depth_layer(gpu, sun.maps().texture(), 0)];
        layers.extend((0..6).map(|face| readback::depth_layer(gpu, lamp.maps().texture(), face)));
        layers
    });
    let covered = maps[0]
        .iter()
        .flatten()
        .filter(|depth| **depth > 0.0)
        .count();
    assert!(covered > 5000, "{covered}");
    for (layer, (all, culled)) in maps[0].iter().zip(&maps[1]).enumerate() {
        let different = all.iter().zip(culled).filter(|(a, b)| a != b).count();
        assert_eq!(different, 0, "layer {layer} of {}", gpu.describe());
    }
}
