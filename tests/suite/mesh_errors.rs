//! Tests what `MeshCaster` refuses: each error is provoked and read as a message.

use glam::{Mat4, Vec3};
use shadow_support::mesh::Mesh;
use wgpu_shadows::{
    Aabb, MeshCaster, ShadowCaster, caster::MeshCasterDescriptor, caster::MeshIndices,
    error::CasterError, error::DeviceRefusal,
};

use super::mesh_pipelines::assert_can_be_drawn;
use crate::fixtures::gpu::{gpu, two_gpus};
use crate::fixtures::scene::default_pipeline;

#[test]
fn meshes_that_do_not_fit_their_buffers() {
    use wgpu::BufferUsages as U;
    let gpu = gpu();
    let pipeline = default_pipeline(gpu);
    let mesh = Mesh::cuboid(Vec3::ZERO, Vec3::ONE);
    let vertices = gpu.buffer(&mesh.positions, U::VERTEX);
    let indices = gpu.buffer(&mesh.indices, U::INDEX);
    let through = |buffer: &wgpu::Buffer, count| MeshIndices::Buffer {
        buffer: buffer.clone(),
        format: wgpu::IndexFormat::Uint32,
        indices: 0..count,
        base_vertex: 0,
    };
    let good = MeshCasterDescriptor {
        label: None,
        pipeline: &pipeline,
        vertices: &vertices,
        indices: through(&indices, 36),
        bounds_model: Aabb::new(Vec3::ZERO, Vec3::ONE),
        render_from_model: Mat4::IDENTITY,
    };
    let mut caster = MeshCaster::new(&gpu.device, &good).expect("a valid mesh");
    let no_vertices = gpu.buffer(&mesh.positions, U::STORAGE);
    let no_indices = gpu.buffer(&mesh.indices, U::STORAGE);
    let infinite = Mat4::from_scale(Vec3::new(1.0, f32::INFINITY, 1.0));
    let cases = [
        (
            MeshCasterDescriptor {
                vertices: &no_vertices,
                ..good.clone()
            },
            "MeshCasterDescriptor::vertices must be created with BufferUsages::VERTEX".to_owned(),
        ),
        (
            MeshCasterDescriptor {
                indices: through(&no_indices, 36),
                ..good.clone()
            },
            "MeshCasterDescriptor::indices.buffer must be created with BufferUsages::INDEX"
                .to_owned(),
        ),
        (
            MeshCasterDescriptor {
                indices: through(&indices, 37),
                ..good.clone()
            },
            "MeshCasterDescriptor::indices.buffer must hold 148 bytes, got 144".to_owned(),
        ),
        (
            MeshCasterDescriptor {
                indices: MeshIndices::None { vertices: 0..9 },
                ..good.clone()
            },
            "MeshCasterDescriptor::vertices must hold 108 bytes, got 96".to_owned(),
        ),
        (
            MeshCasterDescriptor {
                render_from_model: infinite,
                ..good.clone()
            },
            format!("MeshCasterDescriptor::render_from_model must be finite, got {infinite}"),
        ),
    ];
    for (descriptor, message) in cases {
        let error = MeshCaster::new(&gpu.device, &descriptor).expect_err(&message);
        assert_eq!(error.to_string(), message);
    }
    let error = caster.set_transform(infinite).expect_err("infinite");
    assert!(matches!(error, CasterError::NotFinite { .. }), "{error}");
    assert_eq!(caster.render_from_model(), Mat4::IDENTITY);
}

/// Pipeline and buffers must be those of the device that is passed.
#[test]
fn meshes_of_another_device() {
    let [here, there] = two_gpus();
    let mesh = Mesh::cuboid(Vec3::ZERO, Vec3::ONE);
    let pipelines = [&here, &there].map(default_pipeline);
    let vertices =
        [&here, &there].map(|gpu| gpu.buffer(&mesh.positions, wgpu::BufferUsages::VERTEX));
    let indices = [&here, &there].map(|gpu| gpu.buffer(&mesh.indices, wgpu::BufferUsages::INDEX));
    let create = |pipeline: usize, vertex: usize, index: usize| {
        MeshCaster::new(
            &here.device,
            &MeshCasterDescriptor {
                label: None,
                pipeline: &pipelines[pipeline],
                vertices: &vertices[vertex],
                indices: MeshIndices::Buffer {
                    buffer: indices[index].clone(),
                    format: wgpu::IndexFormat::Uint32,
                    indices: 0..36,
                    base_vertex: 0,
                },
                bounds_model: mesh.bounds(),
                render_from_model: Mat4::IDENTITY,
            },
        )
    };
    assert_can_be_drawn(&here, &create(0, 0, 0).expect("all of one device"));
    let field = "MeshCasterDescriptor::pipeline";
    let error = create(1, 0, 0).expect_err(field);
    assert_eq!(error, CasterError::OtherDevice { field });
    assert_eq!(
        error.to_string(),
        format!("{field} must have been made on the device that is passed")
    );
    for (created, wanted) in [
        (create(0, 1, 0), "MeshCasterDescriptor::vertices"),
        (create(0, 0, 1), "MeshCasterDescriptor::indices.buffer"),
    ] {
        let error = created.expect_err(wanted);
        let CasterError::Buffer {
            field,
            refusal: DeviceRefusal::Refused(words),
        } = &error
        else {
            panic!("{error:?}");
        };
        assert_eq!(*field, wanted);
        assert_eq!(
            error.to_string(),
            format!("{field} cannot be used on the device: {words}")
        );
    }
}

/// Bounds that are neither finite nor empty are refused when they are given, and so are transforms
/// that make them so: one mesh must not prevent the frame of all.
#[test]
fn bounds_without_end() {
    let gpu = gpu();
    let mesh = Mesh::cuboid(Vec3::ZERO, Vec3::ONE);
    let pipeline = default_pipeline(gpu);
    let mut caster = mesh.caster(gpu, &pipeline, Mat4::IDENTITY);
    let (bounds, revision) = (caster.bounds(), caster.revision());
    let is_refused =
        |result: Result<(), CasterError>| matches!(result, Err(CasterError::NotFinite { .. }));
    for bad in [
        Aabb::new(Vec3::splat(f32::NAN), Vec3::ONE),
        Aabb::new(Vec3::ZERO, Vec3::new(1.0, f32::NAN, 1.0)),
        Aabb::new(Vec3::NEG_INFINITY, Vec3::INFINITY),
        Aabb::from_points([Vec3::ZERO, Vec3::splat(f32::NAN), Vec3::ONE]),
        Aabb::from_points([Vec3::splat(f32::NAN), Vec3::ZERO, Vec3::ONE]),
    ] {
        assert!(is_refused(caster.geometry_changed(bad)), "{bad:?}");
        let created = MeshCaster::new(
            &gpu.device,
            &MeshCasterDescriptor {
                label: None,
                pipeline: &pipeline,
                vertices: &gpu.buffer(&mesh.positions, wgpu::BufferUsages::VERTEX),
                indices: MeshIndices::None { vertices: 0..6 },
                bounds_model: bad,
                render_from_model: Mat4::IDENTITY,
            },
        );
        assert!(is_refused(created.map(|_| ())), "{bad:?}");
    }
    let huge = Mat4::from_scale(Vec3::splat(f32::MAX)) * Mat4::from_translation(Vec3::ONE);
    assert!(huge.is_finite() && is_refused(caster.set_transform(huge)));
    assert_eq!((caster.bounds(), caster.revision()), (bounds, revision));
    assert_eq!(caster.render_from_model(), Mat4::IDENTITY);
    // Empty bounds are no error: the mesh casts nothing.
    caster.geometry_changed(Aabb::EMPTY).expect("empty bounds");
    assert!(caster.bounds().is_empty());
}
