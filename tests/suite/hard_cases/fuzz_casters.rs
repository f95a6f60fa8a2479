//! Passes any layout, state, text, buffer and range to the casters.

use std::cell::RefCell;

use glam::{DVec3, Mat4, Vec3};
use proptest::prelude::*;
use shadow_support::probe::Point;
use wgpu_shadows::{
    Aabb, CasterPipeline, DepthFormat, MeshCaster, caster::CasterPipelineDescriptor,
    caster::CasterVertex, caster::MeshCasterDescriptor, caster::MeshIndices,
    caster::ModelTransform, caster::PositionAttribute,
};

use super::fuzz_values::{Counts, bounds, matrix, run};
use super::stage::{Sun, shining};
use crate::fixtures::frames::{Coverage, DirectionalFrame, RecordFrame};
use crate::fixtures::gpu::gpu;

/// Generates numbers of bytes and of vertices: small, aligned or not, and huge.
fn count() -> impl Strategy<Value = u32> + Clone {
    prop_oneof![8 => (0..40_u32).prop_map(|n| n * 4), 4 => 0..100_u32, 1 => any::<u32>(), 1 => Just(u32::MAX)]
}

fn vertex_format() -> impl Strategy<Value = wgpu::VertexFormat> {
    use wgpu::VertexFormat as F;
    prop::sample::select(vec![
        F::Float32x3,
        F::Float32x3,
        F::Float32x3,
        F::Float32,
        F::Float32x2,
        F::Float32x4,
        F::Float16,
        F::Float16x2,
        F::Float16x4,
        F::Float64x3,
        F::Sint32x3,
        F::Uint8x4,
        F::Uint16,
        F::Snorm8,
        F::Snorm8x2,
        F::Snorm16x4,
        F::Unorm8x4Bgra,
        F::Unorm10_10_10_2,
        F::Unorm16x2,
    ])
}

fn depth_formats() -> impl Strategy<Value = Vec<DepthFormat>> {
    let one = prop::sample::select(vec![DepthFormat::Float32, DepthFormat::Unorm16]);
    prop_oneof![4 => prop::collection::vec(one.clone(), 1..3), 1 => prop::collection::vec(one, 0..4)]
}

/// Generates the state that a pipeline has in addition to its vertex stage.
fn primitive() -> impl Strategy<
    Value = (
        Option<wgpu::Face>,
        wgpu::FrontFace,
        wgpu::PrimitiveTopology,
        Option<wgpu::IndexFormat>,
    ),
> {
    use wgpu::PrimitiveTopology as T;
    (
        prop::sample::select(vec![None, Some(wgpu::Face::Front), Some(wgpu::Face::Back)]),
        prop::sample::select(vec![wgpu::FrontFace::Ccw, wgpu::FrontFace::Cw]),
        prop::sample::select(vec![
            T::TriangleList,
            T::TriangleList,
            T::TriangleList,
            T::TriangleList,
            T::TriangleList,
            T::TriangleList,
            T::TriangleList,
            T::TriangleList,
            T::TriangleStrip,
            T::LineList,
            T::LineStrip,
            T::PointList,
        ]),
        prop::sample::select(vec![
            None,
            None,
            None,
            Some(wgpu::IndexFormat::Uint16),
            Some(wgpu::IndexFormat::Uint32),
        ]),
    )
}

fn model() -> impl Strategy<Value = ModelTransform> {
    let wide = prop_oneof![5 => Just((64, 0)), 1 => (count(), count())];
    prop_oneof![
        Just(ModelTransform::Identity),
        wide.prop_map(|(array_stride, offset)| ModelTransform::InstanceMatrix {
            array_stride: u64::from(array_stride),
            offset: u64::from(offset),
        }),
    ]
}

/// Any vertex layout, state, formats and shader text give pipelines that can be drawn with, or an
/// error.
#[test]
fn any_pipeline_is_taken_or_refused() {
    const GOOD: &str = "@vertex fn v(@location(0) p: vec3<f32>) -> @builtin(position) vec4<f32> { return shadow_caster_clip(p); }\n@fragment fn f() {}";
    let counts = Counts::default();
    let layout = prop_oneof![
        4 => Just((16, 4, wgpu::VertexFormat::Float32x3)),
        1 => (count(), count(), vertex_format()),
    ];
    let position = (layout, any::<bool>());
    // The text has a piece cut out, or one of its characters replaced.
    let text = (0..12, 0..GOOD.len(), 0..GOOD.len(), any::<char>());
    let entries = prop::sample::select(vec![
        ("v", None),
        ("v", Some("f")),
        ("v", None),
        ("v", Some("f")),
        ("f", Some("v")),
        ("", Some("")),
        ("w", None),
    ]);
    let all = (
        position,
        model(),
        primitive(),
        depth_formats(),
        text,
        entries,
    );
    run(
        200,
        all,
        |(position, model, primitive, formats, text, entries)| {
            let (cull, front_face, topology, strip_index_format) = primitive;
            let ((stride, offset, format), tight) = position;
            let (kind, a, b, character) = text;
            let mut source = GOOD.to_owned();
            match kind {
                0 => source.replace_range(a.min(b)..a.max(b), ""),
                1 => source.replace_range(a..a, &character.to_string()),
                _ => {}
            }
            let attributes = [wgpu::VertexAttribute {
                format,
                offset: u64::from(offset),
                shader_location: 0,
            }];
            let buffers = [Some(wgpu::VertexBufferLayout {
                array_stride: u64::from(stride),
                step_mode: wgpu::VertexStepMode::Vertex,
                attributes: &attributes,
            })];
            let vertex = if kind < 5 {
                CasterVertex::Wgsl {
                    source: &source,
                    vertex_entry: entries.0,
                    fragment_entry: entries.1,
                    buffers: &buffers,
                    bind_group_layouts: &[],
                }
            } else {
                let position = if tight {
                    PositionAttribute {
                        format,
                        ..PositionAttribute::float32x3(u64::from(stride))
                    }
                } else {
                    PositionAttribute {
                        array_stride: u64::from(stride),
                        offset: u64::from(offset),
                        format,
                    }
                };
                CasterVertex::BuiltIn { position, model }
            };
            let descriptor = CasterPipelineDescriptor {
                vertex,
                primitive: wgpu::PrimitiveState {
                    cull_mode: cull,
                    front_face,
                    topology,
                    strip_index_format,
                    ..Default::default()
                },
                depth_formats: &formats,
                ..CasterPipelineDescriptor::new()
            };
            counts.count(&CasterPipeline::new(&gpu().device, &descriptor));
            Ok(())
        },
    );
    counts.finish(
        "any layout, state and shader text of a caster pipeline",
        "a pipeline or an error, no panic, no device error",
    );
}

/// Any buffers and ranges give a mesh that is drawn without an error of the device, or an error.
#[test]
fn any_buffers_of_a_mesh_are_taken_or_refused() {
    let gpu = gpu();
    let counts = Counts::default();
    let pipeline = |topology, strip_index_format, model| {
        let descriptor = CasterPipelineDescriptor {
            vertex: CasterVertex::BuiltIn {
                position: PositionAttribute::float32x3(12),
                model,
            },
            primitive: wgpu::PrimitiveState {
                topology,
                strip_index_format,
                ..Default::default()
            },
            ..CasterPipelineDescriptor::new()
        };
        CasterPipeline::new(&gpu.device, &descriptor).expect("a valid pipeline")
    };
    use wgpu::PrimitiveTopology as T;
    let pipelines = [
        pipeline(T::TriangleList, None, ModelTransform::INSTANCE_MATRIX),
        pipeline(T::TriangleList, None, ModelTransform::Identity),
        pipeline(
            T::TriangleStrip,
            Some(wgpu::IndexFormat::Uint16),
            ModelTransform::INSTANCE_MATRIX,
        ),
        pipeline(T::TriangleStrip, None, ModelTransform::Identity),
    ];
    let sun = RefCell::new(Sun::of_size(16));
    let usage = |right| {
        let wrong = [
            wgpu::BufferUsages::VERTEX,
            wgpu::BufferUsages::INDEX,
            wgpu::BufferUsages::COPY_DST,
        ];
        prop_oneof![6 => Just(right), 1 => prop::sample::select(wrong.to_vec())]
    };
    use wgpu::BufferUsages as U;
    let sizes = (0..300_u64, 0..100_u64, usage(U::VERTEX), usage(U::INDEX));
    // Most of the ranges fit into small buffers.
    let ends = prop_oneof![5 => (0..8_u32, 8..60_u32), 1 => (count(), count())];
    let range = (ends, any::<i32>(), any::<bool>(), any::<bool>());
    let placed = (0..4_usize, bounds(), matrix(), prop::bool::weighted(0.7));
    run(300, (sizes, range, placed), |(sizes, range, placed)| {
        let (vertex_bytes, index_bytes, vertex_usage, index_usage) = sizes;
        let ((start, end), base_vertex, indexed, wide) = range;
        let (which, bounds_model, render_from_model, still) = placed;
        let buffer = |words: u64, usage| {
            gpu.device.create_buffer(&wgpu::BufferDescriptor {
                label: None,
                size: words * 4,
                usage,
                mapped_at_creation: false,
            })
        };
        let indices = if indexed {
            MeshIndices::Buffer {
                buffer: buffer(index_bytes, index_usage),
                format: if wide {
                    wgpu::IndexFormat::Uint32
                } else {
                    wgpu::IndexFormat::Uint16
                },
                indices: start..end,
                base_vertex,
            }
        } else {
            MeshIndices::None {
                vertices: start..end,
            }
        };
        let descriptor = MeshCasterDescriptor {
            label: None,
            pipeline: &pipelines[which],
            vertices: &buffer(vertex_bytes, vertex_usage),
            indices,
            bounds_model,
            render_from_model: if still {
                Mat4::IDENTITY
            } else {
                render_from_model
            },
        };
        let result = MeshCaster::new(&gpu.device, &descriptor);
        counts.count(&result);
        let Ok(mesh) = result else { return Ok(()) };
        let mut sun = sun.borrow_mut();
        let mut encoder = gpu.encoder();
        let frame = DirectionalFrame {
            origin: DVec3::ZERO,
            light: shining(DVec3::NEG_Y),
            coverage: Coverage::Bounds(Aabb::new(Vec3::splat(-9.0), Vec3::splat(9.0))),
            casters: &[&mesh],
            receivers: &[],
        };
        let _ = sun.shadow.record_frame(&mut encoder, &frame);
        gpu.submit(encoder);
        let seen = sun.ask(&[Point::new(Vec3::ZERO, Vec3::Y)])[0];
        prop_assert!((0.0..=1.0).contains(&seen), "{}", seen);
        Ok(())
    });
    counts.finish(
        "any buffers, ranges and indices of a mesh",
        "drawn or refused, no panic, no device error",
    );
}
