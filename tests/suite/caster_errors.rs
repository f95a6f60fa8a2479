//! Tests what `CasterPipeline` refuses: each error is provoked, compared as a value, and read as a
//! message.

use wgpu_shadows::{
    CasterPipeline, caster::CasterPipelineDescriptor, caster::CasterVertex, caster::ModelTransform,
    caster::PositionAttribute, error::CasterError, error::DeviceError, error::DeviceRefusal,
};

use crate::fixtures::gpu::gpu;

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
                "{field}: offset {offset} + {size} bytes must lie inside the stride of {array_stride} bytes, and offset and stride must be multiples of 4"
            )
        );
    }
}

#[test]
fn topologies_that_are_no_triangles() {
    use wgpu::PrimitiveTopology as T;
    for topology in [T::PointList, T::LineList, T::LineStrip] {
        let error = pipeline(&CasterPipelineDescriptor {
            primitive: wgpu::PrimitiveState {
                topology,
                ..Default::default()
            },
            ..CasterPipelineDescriptor::new()
        });
        let error = error.expect_err("a topology");
        assert_eq!(error, CasterError::Topology { topology });
        let message =
            "CasterPipelineDescriptor::primitive.topology must be a triangle topology, got ";
        assert_eq!(error.to_string(), format!("{message}{topology:?}"));
    }
    let error = pipeline(&CasterPipelineDescriptor {
        primitive: wgpu::PrimitiveState {
            strip_index_format: Some(wgpu::IndexFormat::Uint16),
            ..Default::default()
        },
        ..CasterPipelineDescriptor::new()
    });
    let error = error.expect_err("a strip format");
    let topology = T::TriangleList;
    assert_eq!(error, CasterError::StripIndexFormat { topology });
    assert_eq!(
        error.to_string(),
        "CasterPipelineDescriptor::primitive.strip_index_format goes with strip topologies only, got TriangleList"
    );
}

/// What only the device can judge is returned with the device's own message, for every way in which
/// the engine's WGSL can be wrong.
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
        let CasterError::Device(DeviceError {
            object,
            refusal: DeviceRefusal::Refused(message),
        }) = &error
        else {
            panic!("{error:?}");
        };
        assert!(message.contains(word), "{message}");
        let text = format!("the device did not make {object}: {message}");
        assert_eq!(error.to_string(), text);
    }
}

/// wgpu itself panics if there are more bind groups than it has room for, whatever the device's
/// limits.
#[test]
fn more_bind_groups_than_the_device_takes() {
    let gpu = gpu();
    let layout = gpu
        .device
        .create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: None,
            entries: &[],
        });
    let maximum = gpu.device.limits().max_bind_groups;
    for count in [maximum as usize - 1, maximum as usize, 7, 8, 9, 40] {
        let layouts = vec![Some(&layout); count];
        let vertex = CasterVertex::Wgsl {
            source: "@vertex fn vertex() -> @builtin(position) vec4<f32> {
                return shadow_caster_clip(vec3<f32>(0.0));
            }",
            vertex_entry: "vertex",
            fragment_entry: None,
            buffers: &[],
            bind_group_layouts: &layouts,
        };
        let created = pipeline(&CasterPipelineDescriptor {
            vertex,
            ..CasterPipelineDescriptor::new()
        });
        if count < maximum as usize {
            created.expect("room for all groups");
            continue;
        }
        let error = created.expect_err("too many groups");
        let (field, value) = ("CasterPipelineDescriptor::vertex", count as u64 + 1);
        let wanted = CasterError::OverDeviceLimit {
            field,
            limit: "max_bind_groups",
            maximum: maximum.into(),
            value,
        };
        assert_eq!(error, wanted);
        assert_eq!(
            error.to_string(),
            format!(
                "{field}: the device's max_bind_groups must be at least {value}, and it is {maximum}"
            )
        );
    }
}

/// Any number of vertex buffers and attributes gives a pipeline or an error, never a panic.
#[test]
fn more_vertex_buffers_than_the_device_takes() {
    for count in [0, 1, 8, 15, 16, 17, 40, 300] {
        let attributes: Vec<_> = (0..count)
            .map(|location| wgpu::VertexAttribute {
                format: wgpu::VertexFormat::Float32,
                offset: 0,
                shader_location: location,
            })
            .collect();
        let buffers: Vec<_> = attributes
            .iter()
            .map(|attribute| {
                Some(wgpu::VertexBufferLayout {
                    array_stride: 4,
                    step_mode: wgpu::VertexStepMode::Vertex,
                    attributes: std::slice::from_ref(attribute),
                })
            })
            .collect();
        let vertex = CasterVertex::Wgsl {
            source: "@vertex fn vertex() -> @builtin(position) vec4<f32> {
                return shadow_caster_clip(vec3<f32>(0.0));
            }",
            vertex_entry: "vertex",
            fragment_entry: None,
            buffers: &buffers,
            bind_group_layouts: &[],
        };
        let created = pipeline(&CasterPipelineDescriptor {
            vertex,
            ..CasterPipelineDescriptor::new()
        });
        let fits = count <= gpu().device.limits().max_vertex_buffers;
        assert_eq!(created.is_ok(), fits, "{count} buffers: {created:?}");
    }
}

/// A primitive state that rasterizes other than a depth map needs is refused, whatever features the
/// device has.
#[test]
fn primitives_that_give_no_depth_map() {
    let plain = wgpu::PrimitiveState::default();
    for primitive in [
        wgpu::PrimitiveState {
            polygon_mode: wgpu::PolygonMode::Line,
            ..plain
        },
        wgpu::PrimitiveState {
            unclipped_depth: true,
            ..plain
        },
        wgpu::PrimitiveState {
            conservative: true,
            ..plain
        },
    ] {
        let error = pipeline(&CasterPipelineDescriptor {
            primitive,
            ..CasterPipelineDescriptor::new()
        });
        let wanted = CasterError::Primitive {
            unclipped_depth: primitive.unclipped_depth,
            polygon_mode: primitive.polygon_mode,
            conservative: primitive.conservative,
        };
        assert_eq!(error.expect_err("no depth map"), wanted);
    }
}
