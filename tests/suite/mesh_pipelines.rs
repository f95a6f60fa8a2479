//! Tests which meshes go with which pipelines: `MeshCaster` refuses the others, and what it accepts
//! can be drawn.

use glam::{DVec3, Mat4, Vec3};
use shadow_support::mesh::Mesh;
use wgpu_shadows::{
    Aabb, CasterPipeline, DirectionalLight, DirectionalShadow, MeshCaster,
    caster::CasterPipelineDescriptor, caster::CasterVertex, caster::MeshCasterDescriptor,
    caster::MeshIndices, error::CasterError,
};

use crate::fixtures::frames::{Coverage, DirectionalFrame};
use crate::fixtures::gpu::{Gpu, gpu};
use crate::fixtures::probe::record;
use crate::fixtures::scene::default_pipeline;

/// Errors that wgpu would find only while it records are found when the mesh is created.
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
        primitive: wgpu::PrimitiveState {
            topology: wgpu::PrimitiveTopology::TriangleStrip,
            strip_index_format: Some(short),
            ..Default::default()
        },
        ..CasterPipelineDescriptor::new()
    };
    let strip = CasterPipeline::new(&gpu.device, &descriptor).expect("a valid strip");
    assert_eq!(create(&strip, through(short, 0..8)), Ok(()));
    let error = create(&strip, through(long, 0..8)).expect_err("a format");
    let wanted = CasterError::IndexFormat {
        field: "MeshCasterDescriptor::indices.format",
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

/// What wgpu would refuse or panic over while it records is refused by `MeshCaster::new`, or draws
/// nothing. An encoder is finished and submitted with every mesh that is accepted.
#[test]
fn meshes_that_cannot_be_drawn() {
    use wgpu::BufferUsages as U;
    let gpu = gpu();
    let list = default_pipeline(gpu);
    let strip = |strip_index_format| {
        let descriptor = CasterPipelineDescriptor {
            primitive: wgpu::PrimitiveState {
                topology: wgpu::PrimitiveTopology::TriangleStrip,
                strip_index_format,
                ..Default::default()
            },
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
            assert_can_be_drawn(gpu, &caster);
        }));
        if drawn.is_err() {
            failures.push(name);
        }
    }
    assert!(failures.is_empty(), "accepted, and not drawn: {failures:?}");
}

/// Creates a pipeline with the engine's own vertex stage.
fn engine_pipeline(
    gpu: &Gpu,
    source: &str,
    buffers: &[Option<wgpu::VertexBufferLayout<'_>>],
    bind_group_layouts: &[Option<&wgpu::BindGroupLayout>],
) -> CasterPipeline {
    CasterPipeline::new(
        &gpu.device,
        &CasterPipelineDescriptor {
            vertex: CasterVertex::Wgsl {
                source,
                vertex_entry: "vertex",
                fragment_entry: None,
                buffers,
                bind_group_layouts,
            },
            ..CasterPipelineDescriptor::new()
        },
    )
    .expect("a valid pipeline")
}

/// A mesh sets vertex buffer 0, and buffer 1 for the built-in matrix: a pipeline that reads more
/// would make the encoder invalid.
#[test]
fn pipelines_that_take_more_than_a_mesh_sets() {
    let gpu = gpu();
    let attribute = |location, step_mode| {
        let attributes: &'static [wgpu::VertexAttribute] = match location {
            0 => &wgpu::vertex_attr_array![0 => Float32x3],
            _ => &wgpu::vertex_attr_array![1 => Float32x3],
        };
        Some(wgpu::VertexBufferLayout {
            array_stride: 12,
            step_mode,
            attributes,
        })
    };
    let (per_vertex, per_instance) = (
        attribute(0, wgpu::VertexStepMode::Vertex),
        attribute(0, wgpu::VertexStepMode::Instance),
    );
    let one = "@vertex fn vertex(@location(0) place: vec3<f32>) -> @builtin(position) vec4<f32> {
        return shadow_caster_clip(place);
    }";
    let two = "@vertex fn vertex(@location(0) place: vec3<f32>, @location(1) shift: vec3<f32>)
        -> @builtin(position) vec4<f32> {
        return shadow_caster_clip(place + shift);
    }";
    let none =
        "@vertex fn vertex(@builtin(vertex_index) index: u32) -> @builtin(position) vec4<f32> {
        return shadow_caster_clip(vec3<f32>(f32(index)));
    }";
    let layout = gpu
        .device
        .create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: None,
            entries: &[],
        });
    let only = std::slice::from_ref;
    let second = attribute(1, wgpu::VertexStepMode::Instance);
    let cases = [
        (engine_pipeline(gpu, one, only(&per_vertex), &[]), None),
        (engine_pipeline(gpu, none, &[], &[]), None),
        (
            engine_pipeline(gpu, two, &[per_vertex.clone(), second], &[]),
            Some("vertex buffer 1"),
        ),
        (
            engine_pipeline(gpu, one, only(&per_vertex), &[Some(&layout)]),
            Some("bind group 1"),
        ),
        (
            engine_pipeline(gpu, one, only(&per_vertex), &[None, Some(&layout)]),
            Some("bind group 2"),
        ),
    ];
    let mesh = Mesh::cuboid(Vec3::ZERO, Vec3::ONE);
    let vertices = gpu.buffer(&mesh.positions, wgpu::BufferUsages::VERTEX);
    let create = |pipeline: &CasterPipeline, vertices, indices| {
        MeshCaster::new(
            &gpu.device,
            &MeshCasterDescriptor {
                label: None,
                pipeline,
                vertices,
                indices,
                bounds_model: mesh.bounds(),
                render_from_model: Mat4::IDENTITY,
            },
        )
    };
    for (pipeline, needs) in &cases {
        let created = create(pipeline, &vertices, MeshIndices::None { vertices: 0..6 });
        match (created, needs) {
            (Ok(caster), None) => assert_can_be_drawn(gpu, &caster),
            (Err(error), Some(needs)) => {
                let wanted = CasterError::MeshPipeline {
                    field: "MeshCasterDescriptor::pipeline",
                    needs: (*needs).to_owned(),
                };
                assert_eq!(error, wanted);
                assert!(error.to_string().ends_with(&format!("takes {needs}")));
            }
            (created, needs) => panic!("{created:?} where {needs:?} is needed"),
        }
    }
    // Vertices of the engine's own layout must be in the buffer as well, and so must the one of a
    // buffer that is read per instance.
    let (drawn, _) = &cases[0];
    let error = create(drawn, &vertices, MeshIndices::None { vertices: 0..9 });
    let wanted = CasterError::BufferTooSmall {
        field: "MeshCasterDescriptor::vertices",
        needed: 108,
        got: 96,
    };
    assert_eq!(error.expect_err("too few vertices"), wanted);
    let stepped = engine_pipeline(gpu, one, &[per_instance], &[]);
    let small = gpu.buffer(&[0.0_f32; 2], wgpu::BufferUsages::VERTEX);
    let indices = || MeshIndices::Buffer {
        buffer: gpu.buffer(&mesh.indices, wgpu::BufferUsages::INDEX),
        format: wgpu::IndexFormat::Uint32,
        indices: 0..36,
        base_vertex: 0,
    };
    let error = create(&stepped, &small, indices()).expect_err("no whole instance");
    assert!(
        matches!(
            error,
            CasterError::BufferTooSmall {
                needed: 12,
                got: 8,
                ..
            }
        ),
        "{error}"
    );
    let caster = create(&stepped, &vertices, indices()).expect("an instance");
    assert_can_be_drawn(gpu, &caster);
}

/// Asserts that a frame with this caster, within -1 to 2 along each axis, draws it.
pub fn assert_can_be_drawn(gpu: &Gpu, caster: &MeshCaster) {
    let mut shadow = DirectionalShadow::new(&gpu.device, &Default::default()).expect("a valid sun");
    let frame = DirectionalFrame {
        origin: DVec3::ZERO,
        light: DirectionalLight::new(Vec3::new(0.1, -1.0, 0.2)),
        coverage: Coverage::Bounds(Aabb::new(Vec3::NEG_ONE, Vec3::splat(2.0))),
        casters: &[caster],
        receivers: &[],
    };
    assert_eq!(record(gpu, &mut shadow, &frame).draws(), 1);
}
