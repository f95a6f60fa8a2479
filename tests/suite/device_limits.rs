//! Tests devices that were created with limits far below the defaults: everything works, or the
//! error names the limit. The device's own error is never returned.

use std::fmt::Debug;

use glam::{DVec3, Mat4, Vec3};
use shadow_support::mesh::Mesh;
use wgpu_shadows::{
    Aabb, CascadeLayout, CasterPipeline, DirectionalLight, DirectionalShadow,
    DirectionalShadowDescriptor, OmniShadow, OmniShadowDescriptor, ShadowBindings,
    ShadowBindingsDescriptor, ShadowError, ShadowViewUniform, SpotShadow, SpotShadowDescriptor,
    caster::CasterPipelineDescriptor, caster::CasterVertex, caster::ModelTransform,
    caster::PositionAttribute, debug::DebugImage, debug::DebugView, error::BindingsError,
    error::CasterError, error::DebugViewError, meter::ErrorMeter, meter::ErrorMeterDescriptor,
    pool::OmniShadowPool, pool::PoolDescriptor, pool::SpotShadowPool,
};

use crate::fixtures::frames::{Coverage, DirectionalFrame, RecordFrame};
use crate::fixtures::gpu::{Gpu, GpuRequest, own_gpu};
use crate::fixtures::picture::{color_pass, color_target};

const VIEW_BYTES: u64 = ShadowViewUniform::SIZE_BYTES;

fn device(lower: impl FnOnce(&mut wgpu::Limits)) -> Gpu {
    let mut limits = wgpu::Limits::default();
    lower(&mut limits);
    own_gpu(GpuRequest {
        limits,
        ..Default::default()
    })
}

/// Returns the value, or `None` for an error of the library's own. Panics with the message of a
/// device's error.
fn answered<T, E: Debug>(result: Result<T, E>, what: &str, refused: &mut usize) -> Option<T> {
    match result {
        Ok(value) => Some(value),
        Err(error) => {
            let text = format!("{error:?}");
            assert!(
                text.starts_with("OverDeviceLimit") || text.starts_with("Group"),
                "{what}: {text}"
            );
            *refused += 1;
            None
        }
    }
}

fn sun_descriptor(cascades: u32) -> DirectionalShadowDescriptor<'static> {
    DirectionalShadowDescriptor {
        map_size: 8,
        layout: CascadeLayout::fixed(cascades),
        ..Default::default()
    }
}

fn pool_descriptor(capacity: u32) -> PoolDescriptor<'static> {
    PoolDescriptor {
        capacity,
        map_size: 8,
        ..Default::default()
    }
}

/// Creates pipelines of the built-in stages, and one of an engine's own with three buffers and two
/// groups.
fn pipelines(gpu: &Gpu, what: &str, refused: &mut usize) -> Option<CasterPipeline> {
    let built_in = |model| {
        let descriptor = CasterPipelineDescriptor {
            vertex: CasterVertex::BuiltIn {
                position: PositionAttribute::float32x3(12),
                model,
            },
            ..CasterPipelineDescriptor::new()
        };
        CasterPipeline::new(&gpu.device, &descriptor)
    };
    answered(built_in(ModelTransform::Identity), what, refused);
    let wide = CasterPipelineDescriptor {
        vertex: CasterVertex::BuiltIn {
            position: PositionAttribute::float32x3(1024),
            model: ModelTransform::Identity,
        },
        ..CasterPipelineDescriptor::new()
    };
    answered(CasterPipeline::new(&gpu.device, &wide), what, refused);
    let attributes = wgpu::vertex_attr_array![0 => Float32x3, 7 => Float32x2];
    let layout = wgpu::VertexBufferLayout {
        array_stride: 20,
        step_mode: wgpu::VertexStepMode::Vertex,
        attributes: &attributes,
    };
    let own = CasterPipelineDescriptor {
        vertex: CasterVertex::Wgsl {
            source: "@vertex fn main(@location(0) position: vec3<f32>, @location(7) uv: vec2<f32>) \
                     -> @builtin(position) vec4<f32> { return shadow_caster_clip(position + uv.xyx); }",
            vertex_entry: "main",
            fragment_entry: None,
            buffers: &[None, None, Some(layout)],
            bind_group_layouts: &[None, None],
        },
        ..CasterPipelineDescriptor::new()
    };
    answered(CasterPipeline::new(&gpu.device, &own), what, refused);
    answered(built_in(ModelTransform::INSTANCE_MATRIX), what, refused)
}

/// Creates everything that the library has, and records frames and draws images where it could be
/// created. Returns the number of refusals.
fn all(gpu: &Gpu, what: &str) -> usize {
    let device = &gpu.device;
    let mut refused = 0;
    let refusals = &mut refused;
    let pipeline = pipelines(gpu, what, refusals);
    let suns = [1, 3, 8]
        .map(|cascades| DirectionalShadow::new(device, &sun_descriptor(cascades)))
        .map(|sun| answered(sun, what, refusals));
    let omni = OmniShadowDescriptor {
        map_size: 8,
        ..Default::default()
    };
    let omni = answered(OmniShadow::new(device, &omni), what, refusals);
    let spot = SpotShadowDescriptor {
        map_size: 8,
        ..Default::default()
    };
    let spot = answered(SpotShadow::new(device, &spot), what, refusals);
    for capacity in [1, 2, 5] {
        let pool = pool_descriptor(capacity);
        answered(OmniShadowPool::new(device, &pool), what, refusals);
        answered(SpotShadowPool::new(device, &pool), what, refusals);
    }
    let formats = [
        wgpu::TextureFormat::Rgba8Unorm,
        wgpu::TextureFormat::Rgba16Float,
    ];
    let [debug_view, _] =
        formats.map(|format| answered(DebugView::new(device, format), what, refusals));

    let lights: Vec<_> = suns
        .iter()
        .flatten()
        .map(DirectionalShadow::maps)
        .chain(omni.as_ref().map(OmniShadow::maps))
        .chain(spot.as_ref().map(SpotShadow::maps))
        .collect();
    let names = ["a", "b", "c", "d", "e"];
    for count in 1..=lights.len() {
        let named: Vec<_> = names.iter().copied().zip(lights.iter().copied()).collect();
        let descriptor = ShadowBindingsDescriptor {
            group: 0,
            lights: &named[..count],
            ..Default::default()
        };
        answered(ShadowBindings::new(device, &descriptor), what, refusals);
    }
    for &maps in &lights {
        let descriptor = ErrorMeterDescriptor {
            places_per_frame: 2,
            ..ErrorMeterDescriptor::new(maps)
        };
        answered(ErrorMeter::new(&descriptor), what, refusals);
    }
    if let (Some(view), true) = (&debug_view, !lights.is_empty()) {
        let target = color_target(gpu, 4);
        let mut encoder = gpu.encoder();
        {
            let mut pass = color_pass(&mut encoder, &target);
            for light in &lights {
                view.draw(&mut pass, light, DebugImage::Layer(0))
                    .expect("a picture");
            }
        }
        gpu.submit(encoder);
    }
    let (Some(pipeline), Some(mut sun)) = (pipeline, suns.into_iter().flatten().last()) else {
        return refused;
    };
    let slab = Mesh::cuboid(Vec3::new(-1.0, 1.0, -1.0), Vec3::new(1.0, 1.2, 1.0));
    let slab = slab.caster(gpu, &pipeline, Mat4::IDENTITY);
    let mut encoder = gpu.encoder();
    let frame = DirectionalFrame {
        origin: DVec3::ZERO,
        light: DirectionalLight::new(Vec3::NEG_Y),
        coverage: Coverage::Bounds(Aabb::new(Vec3::splat(-2.0), Vec3::splat(2.0))),
        casters: &[&slab],
        receivers: &[],
    };
    sun.record_frame(&mut encoder, &frame).expect(what);
    gpu.submit(encoder);
    refused
}

type Lower = fn(&mut wgpu::Limits, u32);

/// Lists each limit that an object of the library could exceed, with the values to lower it to.
#[rustfmt::skip]
const LIMITS: [(&str, &[u32], Lower); 17] = [
    ("max_texture_dimension_2d", &[4, 7, 8], |limits, value| limits.max_texture_dimension_2d = value),
    ("max_texture_array_layers", &[1, 2, 5, 6, 7, 8], |limits, value| limits.max_texture_array_layers = value),
    ("max_bind_groups", &[1, 2, 3], |limits, value| limits.max_bind_groups = value),
    ("max_bind_groups_plus_vertex_buffers", &[1, 2, 3, 5, 6], |limits, value| limits.max_bind_groups_plus_vertex_buffers = value),
    ("max_bindings_per_bind_group", &[1, 2, 3, 4, 7], |limits, value| limits.max_bindings_per_bind_group = value),
    ("max_dynamic_uniform_buffers_per_pipeline_layout", &[0, 1], |limits, value| limits.max_dynamic_uniform_buffers_per_pipeline_layout = value),
    ("max_sampled_textures_per_shader_stage", &[0, 1, 2], |limits, value| limits.max_sampled_textures_per_shader_stage = value),
    ("max_samplers_per_shader_stage", &[0, 1], |limits, value| limits.max_samplers_per_shader_stage = value),
    ("max_uniform_buffers_per_shader_stage", &[0, 1, 2, 3], |limits, value| limits.max_uniform_buffers_per_shader_stage = value),
    ("max_uniform_buffer_binding_size", &[64, 240, 480, 1440, 1680, 1920], |limits, value| limits.max_uniform_buffer_binding_size = value.into()),
    ("max_buffer_size", &[512, 768, 1536, 2048], |limits, value| limits.max_buffer_size = value.into()),
    ("max_vertex_buffers", &[0, 1, 2, 3], |limits, value| limits.max_vertex_buffers = value),
    ("max_vertex_attributes", &[1, 4, 5, 7, 8], |limits, value| limits.max_vertex_attributes = value),
    ("max_vertex_buffer_array_stride", &[12, 63, 64, 1023], |limits, value| limits.max_vertex_buffer_array_stride = value),
    ("max_inter_stage_shader_variables", &[1, 2], |limits, value| limits.max_inter_stage_shader_variables = value),
    ("max_color_attachments", &[0, 1], |limits, value| limits.max_color_attachments = value),
    ("max_color_attachment_bytes_per_sample", &[4, 8, 16], |limits, value| limits.max_color_attachment_bytes_per_sample = value),
];

#[test]
fn every_low_limit_is_kept_or_named() {
    for (name, values, lower) in LIMITS {
        let mut refused = Vec::new();
        for &value in values {
            let gpu = device(|limits| lower(limits, value));
            refused.push(all(&gpu, &format!("{name} = {value}")));
        }
        // The debug view needs one variable between stages, and no device has fewer.
        let lowest_serves = name == "max_inter_stage_shader_variables";
        assert_eq!(refused[0] == 0, lowest_serves, "{name}: {refused:?}");
        assert!(
            refused.is_sorted_by(|before, after| before >= after),
            "{name}: {refused:?}"
        );
    }
    // The alignment is the one limit that is worse the larger it is.
    let gpu = device(|limits| limits.min_uniform_buffer_offset_alignment = 1024);
    assert_eq!(all(&gpu, "alignment 1024"), 0);
    assert_eq!(all(&device(|_| ()), "the defaults"), 0);
}

/// Returns the number of layers that are allocated: on OpenGL an array of one layer, or of six, has
/// one layer more.
fn allocated(gpu: &Gpu, layers: u64) -> u64 {
    let opengl = gpu.adapter.backend == wgpu::Backend::Gl;
    layers + u64::from(opengl && (layers == 1 || layers.is_multiple_of(6)))
}

#[test]
fn lights_with_more_layers_than_the_device_has() {
    let gpu = device(|limits| limits.max_texture_array_layers = 4);
    let limit = "max_texture_array_layers";
    let error = DirectionalShadow::new(&gpu.device, &sun_descriptor(5)).expect_err("five layers");
    let field = "DirectionalShadowDescriptor::layout";
    let over = |field, value| ShadowError::OverDeviceLimit {
        field,
        limit,
        maximum: 4,
        value,
    };
    assert_eq!(error, over(field, 5));
    assert_eq!(
        error.to_string(),
        format!("{field}: the device's {limit} must be at least 5, and it is 4")
    );
    DirectionalShadow::new(&gpu.device, &sun_descriptor(4)).expect("four layers");
    let error = OmniShadow::new(&gpu.device, &Default::default()).expect_err("six layers");
    assert_eq!(
        error,
        over("the six faces of an OmniShadow", allocated(&gpu, 6))
    );
    // The views of a pool share one layer, however many they are.
    OmniShadowPool::new(&gpu.device, &pool_descriptor(5)).expect("one layer");
}

#[test]
fn uniforms_larger_than_the_device_binds() {
    let maximum = 4 * VIEW_BYTES;
    let gpu = device(|limits| limits.max_uniform_buffer_binding_size = maximum);
    let limit = "max_uniform_buffer_binding_size";
    let over = |field, views| ShadowError::OverDeviceLimit {
        field,
        limit,
        maximum,
        value: views * VIEW_BYTES,
    };
    let error = DirectionalShadow::new(&gpu.device, &sun_descriptor(5)).expect_err("five views");
    assert_eq!(error, over("DirectionalShadowDescriptor::layout", 5));
    DirectionalShadow::new(&gpu.device, &sun_descriptor(4)).expect("four views");
    let error = OmniShadow::new(&gpu.device, &Default::default()).expect_err("six views");
    assert_eq!(error, over("the six faces of an OmniShadow", 6));
    let error = SpotShadowPool::new(&gpu.device, &pool_descriptor(5)).expect_err("five views");
    assert_eq!(error, over("PoolDescriptor::capacity", 5));
    // The product of views and slots does not wrap around.
    let error = OmniShadowPool::new(&gpu.device, &pool_descriptor(u32::MAX)).expect_err("no end");
    assert_eq!(
        error,
        over("PoolDescriptor::capacity", 6 * u64::from(u32::MAX))
    );
    let format = wgpu::TextureFormat::Rgba8Unorm;
    let error = DebugView::new(&gpu.device, format).expect_err("eight views");
    let value = 8 * VIEW_BYTES;
    assert_eq!(
        error,
        DebugViewError::OverDeviceLimit {
            limit,
            maximum,
            value
        }
    );
    assert_eq!(
        error.to_string(),
        format!("DebugView: the device's {limit} must be at least {value}, and it is {maximum}")
    );
    // This light belongs to a device that binds larger uniforms.
    let other = device(|_| ());
    let sun = DirectionalShadow::new(&other.device, &sun_descriptor(5)).expect("five views");
    let descriptor = ShadowBindingsDescriptor {
        lights: &[("sun", sun.maps())],
        ..Default::default()
    };
    let error = ShadowBindings::new(&gpu.device, &descriptor).expect_err("five views");
    let needed = 5 * VIEW_BYTES;
    assert_eq!(
        error,
        BindingsError::OverDeviceLimit {
            limit,
            needed,
            maximum
        }
    );
}

#[test]
fn vertices_that_the_device_does_not_fetch() {
    let gpu = device(|limits| limits.max_vertex_attributes = 4);
    let error = CasterPipeline::new(&gpu.device, &CasterPipelineDescriptor::new());
    let error = error.expect_err("five attributes");
    let field = "CasterPipelineDescriptor::vertex";
    assert_eq!(
        error,
        CasterError::OverDeviceLimit {
            field,
            limit: "max_vertex_attributes",
            maximum: 4,
            value: 5
        }
    );
    assert_eq!(
        error.to_string(),
        format!("{field}: the device's max_vertex_attributes must be at least 5, and it is 4")
    );
}
