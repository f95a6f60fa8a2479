//! What the library's own objects need of a device's limits, checked before anything is made. A device may have been created
//! with limits far below WebGPU's defaults; what it then says of an object is no help to whoever chose a number of cascades.

use crate::cast::{CasterPipelineDescriptor, CasterVertex, ModelTransform};
use crate::cast::{VIEW_UNIFORM_BYTES, allocated_layers};
use crate::receive::ShadowViewUniform;
use crate::{CasterError, DebugViewError, ShadowError};

/// A limit in its own unit, what of it is needed, and what the device has.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Need {
    pub limit: &'static str,
    pub needed: u64,
    pub maximum: u64,
}

impl Need {
    pub fn new(limit: &'static str, needed: impl Into<u64>, maximum: impl Into<u64>) -> Self {
        Self {
            limit,
            needed: needed.into(),
            maximum: maximum.into(),
        }
    }

    /// The first of `needs` that the device does not meet.
    pub fn first_unmet(needs: impl IntoIterator<Item = Self>) -> Option<Self> {
        needs.into_iter().find(|need| need.needed > need.maximum)
    }
}

/// Bytes of the uniforms of `views` views.
pub(crate) fn view_uniform_bytes(views: u64) -> u64 {
    views * size_of::<ShadowViewUniform>() as u64
}

/// Can `device` hold a light of `layers` layers, one view each? `field` is what set their number.
pub(crate) fn check_layers(
    device: &wgpu::Device,
    field: &'static str,
    layers: u64,
) -> Result<(), ShadowError> {
    let limits = device.limits();
    let uniform_bytes = view_uniform_bytes(layers);
    let alignment = u64::from(limits.min_uniform_buffer_offset_alignment);
    let caster_bytes = VIEW_UNIFORM_BYTES.next_multiple_of(alignment) * layers;
    let needs = [
        Need::new(
            "max_texture_array_layers",
            allocated_layers(device, layers),
            limits.max_texture_array_layers,
        ),
        Need::new(
            "max_uniform_buffer_binding_size",
            uniform_bytes,
            limits.max_uniform_buffer_binding_size,
        ),
        Need::new(
            "max_buffer_size",
            uniform_bytes.max(caster_bytes),
            limits.max_buffer_size,
        ),
    ];
    let over = |field| {
        move |need: Need| {
            Err(ShadowError::OverDeviceLimit {
                field,
                limit: need.limit,
                maximum: need.maximum,
                value: need.needed,
            })
        }
    };
    Need::first_unmet(needs).map_or(Ok(()), over(field))?;
    Need::first_unmet(caster_group(&limits)).map_or(Ok(()), over("the depth pass of a light"))
}

/// The bind group of a depth pass: one uniform buffer, chosen by a dynamic offset.
fn caster_group(limits: &wgpu::Limits) -> [Need; 4] {
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

/// What the vertex stage of a caster takes.
#[derive(Clone, Copy, Debug)]
struct VertexNeeds {
    buffers: u64,
    /// Attributes, or one more than the highest location.
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

/// Can `device` make the pipelines of a caster? wgpu panics over more bind groups or vertex buffers than it has room for. What an engine's own bind groups hold is between it and the device.
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

/// Can `device` make a debug view that binds `views` views and draws to `format`?
pub(crate) fn check_debug_view(
    device: &wgpu::Device,
    format: wgpu::TextureFormat,
    views: u64,
) -> Result<(), DebugViewError> {
    let limits = device.limits();
    let bytes = view_uniform_bytes(views);
    // Two uniform buffers, a texture and a sampler.
    let needs = [
        Need::new(
            "max_uniform_buffer_binding_size",
            bytes,
            limits.max_uniform_buffer_binding_size,
        ),
        Need::new("max_buffer_size", bytes, limits.max_buffer_size),
        Need::new("max_bind_groups", 1u32, limits.max_bind_groups),
        Need::new(
            "max_bindings_per_bind_group",
            4u32,
            limits.max_bindings_per_bind_group,
        ),
        Need::new(
            "max_uniform_buffers_per_shader_stage",
            2u32,
            limits.max_uniform_buffers_per_shader_stage,
        ),
        Need::new(
            "max_sampled_textures_per_shader_stage",
            1u32,
            limits.max_sampled_textures_per_shader_stage,
        ),
        Need::new(
            "max_samplers_per_shader_stage",
            1u32,
            limits.max_samplers_per_shader_stage,
        ),
        Need::new(
            "max_inter_stage_shader_variables",
            1u32,
            limits.max_inter_stage_shader_variables,
        ),
        Need::new("max_color_attachments", 1u32, limits.max_color_attachments),
        Need::new(
            "max_color_attachment_bytes_per_sample",
            format.target_pixel_byte_cost().unwrap_or(0),
            limits.max_color_attachment_bytes_per_sample,
        ),
    ];
    match Need::first_unmet(needs) {
        None => Ok(()),
        Some(need) => Err(DebugViewError::OverDeviceLimit {
            limit: need.limit,
            maximum: need.maximum,
            value: need.needed,
        }),
    }
}
