//! What `CasterPipeline` and `MeshCaster` refuse: each error provoked, compared as a value, and read as a message.

use glam::{DVec3, Mat4, Vec3};
use wgpu_shadows::{
    Aabb, CasterError, CasterPipeline, CasterPipelineDescriptor, CasterVertex, Coverage,
    DirectionalFrame, DirectionalLight, DirectionalShadow, MeshCaster, MeshCasterDescriptor,
    MeshIndices, ModelTransform, PositionAttribute,
};

use crate::support::gpu::gpu;
use crate::support::probe::record;
use crate::support::scene::{Mesh, default_pipeline};

fn pipeline(descriptor: &CasterPipelineDescriptor<'_>) -> Result<(), CasterError> {
    CasterPipeline::new(&gpu().device, descriptor).map(|_| ())
}

fn built_in(
    position: PositionAttribute,
    model: ModelTransform,
) -> CasterPipelineDescriptor<'static> {
    CasterPipelineDescriptor {
        vertex: CasterVertex::BuiltIn { position, model },
        ..CasterPipelineDescriptor::new()
    }
}

#[test]
fn vertex_layouts_that_cannot_be_read() {
    use wgpu::VertexFormat as F;
    let formats = [
        F::Uint32x3,
        F::Sint8x4,
        F::Float32,
        F::Float64x3,
        F::Unorm16,
    ];
    for format in formats {
        let position = PositionAttribute {
            format,
            ..PositionAttribute::float32x3(32)
        };
        let error = pipeline(&built_in(position, ModelTransform::Identity)).expect_err("a format");
        assert_eq!(error, CasterError::PositionFormat { format });
        assert_eq!(
            error.to_string(),
            format!(
                "PositionAttribute::format must be a float, snorm or unorm format of 2 to 4 components, got {format:?}"
            )
        );
    }
    let at = |array_stride, offset| PositionAttribute {
        array_stride,
        offset,
        format: F::Float32x3,
    };
    let matrix = |array_stride, offset| ModelTransform::InstanceMatrix {
        array_stride,
        offset,
    };
    let fine = (at(12, 0), matrix(64, 0));
    let cases = [
        ((at(8, 0), fine.1), "PositionAttribute", 0, 12, 8),
        ((at(16, 8), fine.1), "PositionAttribute", 8, 12, 16),
        ((at(18, 0), fine.1), "PositionAttribute", 0, 12, 18),
        ((at(32, 2), fine.1), "PositionAttribute", 2, 12, 32),
        (
            (at(32, u64::MAX), fine.1),
            "PositionAttribute",
            u64::MAX,
            12,
            32,
        ),
        (
            (fine.0, matrix(60, 0)),
            "ModelTransform::InstanceMatrix",
            0,
            64,
            60,
        ),
        (
            (fine.0, matrix(80, 20)),
            "ModelTransform::InstanceMatrix",
            20,
            64,
            80,
        ),
    ];
    for ((position, model), field, offset, size, array_stride) in cases {
        let error = pipeline(&built_in(position, model)).expect_err("a layout");
        let wanted = CasterError::VertexLayout {
            field,
            offset,
            size,
            array_stride,
        };
        assert_eq!(error, wanted);
        assert_eq!(
            error.to_string(),
            format!(
                "{field}: offset {offset} + {size} bytes must lie inside the stride of {array_stride} bytes, both multiples of 4"
            )
        );
    }
}

#[test]
fn topologies_that_are_no_triangles() {
    use wgpu::PrimitiveTopology as T;
    for topology in [T::PointList, T::LineList, T::LineStrip] {
        let error = pipeline(&CasterPipelineDescriptor {
            topology,
            ..CasterPipelineDescriptor::new()
        });
        let error = error.expect_err("a topology");
        assert_eq!(error, CasterError::Topology { topology });
        let message = "CasterPipelineDescriptor::topology must be a triangle topology, got ";
        assert_eq!(error.to_string(), format!("{message}{topology:?}"));
    }
    let error = pipeline(&CasterPipelineDescriptor {
        strip_index_format: Some(wgpu::IndexFormat::Uint16),
        ..CasterPipelineDescriptor::new()
    });
    let error = error.expect_err("a strip format");
    let topology = T::TriangleList;
    assert_eq!(error, CasterError::StripIndexFormat { topology });
    assert_eq!(
        error.to_string(),
        "CasterPipelineDescriptor::strip_index_format goes with strip topologies only, got TriangleList"
    );
}

/// What only the device can judge comes back in its own words, from every way in which the engine's WGSL can be wrong.
#[test]
fn wgsl_that_the_device_refuses() {
    let good = "@vertex fn v(@location(0) p: vec3<f32>) -> @builtin(position) vec4<f32> { return shadow_caster_clip(p); }";
    let attributes = [wgpu::VertexAttribute {
        format: wgpu::VertexFormat::Float32x3,
        offset: 0,
        shader_location: 0,
    }];
    let buffers = [Some(wgpu::VertexBufferLayout {
        array_stride: 12,
        step_mode: wgpu::VertexStepMode::Vertex,
        attributes: &attributes,
    })];
    let with = |source, vertex_entry, fragment_entry, buffers| CasterPipelineDescriptor {
        vertex: CasterVertex::Wgsl {
            source,
            vertex_entry,
            fragment_entry,
            buffers,
            bind_group_layouts: &[],
        },
        ..CasterPipelineDescriptor::new()
    };
    assert_eq!(pipeline(&with(good, "v", None, &buffers)), Ok(()));
    let unbound = "@group(1) @binding(0) var<uniform> t: f32;
        @vertex fn v(@location(0) p: vec3<f32>) -> @builtin(position) vec4<f32> { return shadow_caster_clip(p * t); }";
    let cases = [
        (with("fn v( {", "v", None, &buffers), "expected"),
        (with(good, "w", None, &buffers), "w"),
        (with(good, "v", Some("f"), &buffers), "f"),
        (with(good, "v", None, &[]), "Location"),
        (with(unbound, "v", None, &buffers), "binding"),
    ];
    for (descriptor, word) in cases {
        let error = pipeline(&descriptor).expect_err(word);
        let CasterError::Device { message } = &error else {
            panic!("{error:?}");
        };
        assert!(message.contains(word), "{message}");
        let text = format!("the device refused the caster pipeline: {message}");
        assert_eq!(error.to_string(), text);
    }
}

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
