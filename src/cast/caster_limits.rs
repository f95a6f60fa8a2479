//! Lists what the depth passes and pipelines of casters need of a device's limits.

use crate::cast::pipeline_descriptor::{CasterPipelineDescriptor, CasterVertex, ModelTransform};
use crate::cast::view_uniform::VIEW_UNIFORM_BYTES;
use crate::error::CasterError;
use crate::gpu::Need;

/// Returns the needs of a depth pass's bind group: one uniform buffer, chosen by a dynamic offset.
pub(crate) fn caster_group(limits: &wgpu::Limits) -> [Need; 4] {
    [
        Need::new("max_bind_groups", 1u32, limits.max_bind_groups),
        Need::new(
            "max_bindings_per_bind_group",
            1u32,
            limits.max_bindings_per_bind_group,
        ),
        Need::new(
            "max_uniform_buffers_per_shader_stage",
            1u32,
            limits.max_uniform_buffers_per_shader_stage,
        ),
        Need::new(
            "max_dynamic_uniform_buffers_per_pipeline_layout",
            1u32,
            limits.max_dynamic_uniform_buffers_per_pipeline_layout,
        ),
    ]
}

/// Counts the resources that the vertex stage of a caster takes.
#[derive(Clone, Copy, Debug)]
struct VertexNeeds {
    buffers: u64,
    /// Is the number of attributes, or one more than the highest location if that is larger.
    attributes: u64,
    longest_stride: u64,
    bind_groups: u64,
}

fn vertex_needs(vertex: &CasterVertex<'_>) -> VertexNeeds {
    match vertex {
        CasterVertex::BuiltIn { position, model } => {
            let (buffers, attributes, stride) = match model {
                ModelTransform::Identity => (1, 1, 0),
                ModelTransform::InstanceMatrix { array_stride, .. } => (2, 5, *array_stride),
            };
            VertexNeeds {
                buffers,
                attributes,
                longest_stride: position.array_stride.max(stride),
                bind_groups: 1,
            }
        }
        CasterVertex::Wgsl {
            buffers,
            bind_group_layouts,
            ..
        } => {
            let layouts = || buffers.iter().flatten();
            let attributes = || layouts().flat_map(|layout| layout.attributes);
            let locations = attributes().map(|attribute| u64::from(attribute.shader_location) + 1);
            let strides = layouts().map(|layout| layout.array_stride);
            VertexNeeds {
                buffers: buffers.len() as u64,
                attributes: locations
                    .max()
                    .unwrap_or(0)
                    .max(attributes().count() as u64),
                longest_stride: strides.max().unwrap_or(0),
                bind_groups: 1 + bind_group_layouts.len() as u64,
            }
        }
    }
}

/// Checks that `device` can make the pipelines of a caster. wgpu panics over more bind groups or
/// vertex buffers than it has room for. The contents of an engine's own bind groups are not checked
/// here; the device checks them.
pub(crate) fn check_caster(
    device: &wgpu::Device,
    descriptor: &CasterPipelineDescriptor<'_>,
) -> Result<(), CasterError> {
    let limits = device.limits();
    let vertex = vertex_needs(&descriptor.vertex);
    let needs = [
        Need::new(
            "max_vertex_buffers",
            vertex.buffers,
            limits.max_vertex_buffers,
        ),
        Need::new(
            "max_vertex_attributes",
            vertex.attributes,
            limits.max_vertex_attributes,
        ),
        Need::new(
            "max_vertex_buffer_array_stride",
            vertex.longest_stride,
            limits.max_vertex_buffer_array_stride,
        ),
        Need::new(
            "max_bind_groups",
            vertex.bind_groups,
            limits.max_bind_groups,
        ),
        Need::new(
            "max_bind_groups_plus_vertex_buffers",
            vertex.bind_groups + vertex.buffers,
            limits.max_bind_groups_plus_vertex_buffers,
        ),
        Need::new(
            "max_uniform_buffer_binding_size",
            VIEW_UNIFORM_BYTES,
            limits.max_uniform_buffer_binding_size,
        ),
    ];
    match Need::first_unmet(needs.into_iter().chain(caster_group(&limits))) {
        None => Ok(()),
        Some(need) => Err(CasterError::OverDeviceLimit {
            field: "CasterPipelineDescriptor::vertex",
            limit: need.limit,
            maximum: need.maximum,
            value: need.needed,
        }),
    }
}
