//! What `MeshCaster` refuses: each error provoked and read as a message; and that what it accepts can be drawn.

use glam::{DVec3, Mat4, Vec3};
use wgpu_shadows::{
    Aabb, CasterError, CasterPipeline, CasterPipelineDescriptor, Coverage, DirectionalFrame,
    DirectionalLight, DirectionalShadow, MeshCaster, MeshCasterDescriptor, MeshIndices,
};

use crate::support::gpu::gpu;
use crate::support::probe::record;
use crate::support::scene::{Mesh, default_pipeline};

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
    let error = caster
        .set_transform(&gpu.queue, infinite)
        .expect_err("infinite");
    assert!(matches!(error, CasterError::NotFinite { .. }), "{error}");
    assert_eq!(caster.render_from_model(), Mat4::IDENTITY);
}

/// What of a mesh wgpu would only find wrong while it records.
#[test]
fn meshes_that_do_not_go_with_their_pipelines() {
    let gpu = gpu();
    let mesh = Mesh::cuboid(Vec3::ZERO, Vec3::ONE);
    let vertices = gpu.buffer(&mesh.positions, wgpu::BufferUsages::VERTEX);
    let buffer = gpu.buffer(&mesh.indices, wgpu::BufferUsages::INDEX);
    let create = |pipeline: &CasterPipeline, indices| {
        let descriptor = MeshCasterDescriptor {
            label: None,
            pipeline,
            vertices: &vertices,
            indices,
            bounds_model: mesh.bounds(),
            render_from_model: Mat4::IDENTITY,
        };
        MeshCaster::new(&gpu.device, &descriptor).map(|_| ())
    };
    let through = |format, indices| MeshIndices::Buffer {
        buffer: buffer.clone(),
        format,
        indices,
        base_vertex: 0,
    };
    let list = default_pipeline(gpu);
    let short = wgpu::IndexFormat::Uint16;
    let long = wgpu::IndexFormat::Uint32;
    let descriptor = CasterPipelineDescriptor {
        topology: wgpu::PrimitiveTopology::TriangleStrip,
        strip_index_format: Some(short),
        ..CasterPipelineDescriptor::new()
    };
    let strip = CasterPipeline::new(&gpu.device, &descriptor).expect("a valid strip");
    assert_eq!(create(&strip, through(short, 0..8)), Ok(()));
    let error = create(&strip, through(long, 0..8)).expect_err("a format");
    let wanted = CasterError::IndexFormat {
        expected: Some(short),
        format: long,
    };
    assert_eq!(error, wanted);
    assert_eq!(
        error.to_string(),
        "MeshCasterDescriptor::indices.format must be the strip index format of the pipeline (Some(Uint16)), got Uint32"
    );
    let cases = [
        (MeshIndices::None { vertices: 5..5 }, "vertices", 5),
        (through(long, 7..7), "indices", 7),
    ];
    for (indices, field, end) in cases {
        let error = create(&list, indices).expect_err(field);
        let message =
            format!("MeshCasterDescriptor::indices.{field} must not be empty, got {end}..{end}");
        assert_eq!(error.to_string(), message);
        assert!(matches!(error, CasterError::EmptyRange { start, .. } if start == end));
    }
}

/// What wgpu would refuse or panic over while it records is refused by `MeshCaster::new`, or draws nothing. An encoder is
/// finished and submitted with every mesh that is accepted.
#[test]
fn meshes_that_cannot_be_drawn() {
    use wgpu::BufferUsages as U;
    let gpu = gpu();
    let list = default_pipeline(gpu);
    let strip = |strip_index_format| {
        let descriptor = CasterPipelineDescriptor {
            topology: wgpu::PrimitiveTopology::TriangleStrip,
            strip_index_format,
            ..CasterPipelineDescriptor::new()
        };
        CasterPipeline::new(&gpu.device, &descriptor).expect("a valid strip")
    };
    let (short_strip, plain_strip) = (strip(Some(wgpu::IndexFormat::Uint16)), strip(None));
    let mesh = Mesh::cuboid(Vec3::ZERO, Vec3::ONE);
    let vertices = gpu.buffer(&mesh.positions, U::VERTEX);
    let no_vertices = gpu.buffer(&[] as &[f32], U::VERTEX);
    let through = |format, indices| MeshIndices::Buffer {
        buffer: gpu.buffer(&mesh.indices, U::INDEX),
        format,
        indices,
        base_vertex: 0,
    };
    let long = wgpu::IndexFormat::Uint32;
    #[expect(clippy::reversed_empty_ranges, reason = "the case that is tested")]
    let backwards = 6..3;
    let cases = [
        (
            "a long index for a short strip",
            &short_strip,
            &vertices,
            through(long, 0..12),
        ),
        (
            "an index for a strip that names none",
            &plain_strip,
            &vertices,
            through(long, 0..12),
        ),
        (
            "indices backwards",
            &list,
            &vertices,
            through(long, backwards.clone()),
        ),
        (
            "vertices backwards",
            &list,
            &vertices,
            MeshIndices::None {
                vertices: backwards,
            },
        ),
        (
            "no vertices",
            &list,
            &no_vertices,
            MeshIndices::None { vertices: 0..0 },
        ),
        ("no indices", &list, &vertices, through(long, 0..0)),
    ];
    let mut failures = Vec::new();
    for (name, pipeline, vertices, indices) in cases {
        let descriptor = MeshCasterDescriptor {
            label: None,
            pipeline,
            vertices,
            indices,
            bounds_model: Aabb::new(Vec3::ZERO, Vec3::ONE),
            render_from_model: Mat4::IDENTITY,
        };
        let Ok(caster) = MeshCaster::new(&gpu.device, &descriptor) else {
            continue;
        };
        let drawn = std::panic::catch_unwind(std::panic::AssertUnwindSafe(|| {
            let mut shadow = DirectionalShadow::new(&gpu.device, &Default::default());
            let shadow = shadow.as_mut().expect("a valid sun");
            let frame = DirectionalFrame {
                origin: DVec3::ZERO,
                light: DirectionalLight::new(Vec3::NEG_Y),
                coverage: Coverage::Bounds(Aabb::new(Vec3::NEG_ONE, Vec3::ONE)),
                casters: &[&caster],
                receivers: &[],
            };
            assert_eq!(record(gpu, shadow, &frame).draws(), 1);
        }));
        if drawn.is_err() {
            failures.push(name);
        }
    }
    assert!(failures.is_empty(), "accepted, and not drawn: {failures:?}");
}
