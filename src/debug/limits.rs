//! Checks that a device's limits suffice for a debug view.

use crate::error::DebugViewError;
use crate::gpu::Need;
use crate::receive::view_uniform_bytes;

/// Accepts devices whose limits suffice for a debug view that binds `views` views and draws to
/// `format`.
pub(crate) fn check_debug_view(
    device: &wgpu::Device,
    format: wgpu::TextureFormat,
    views: u64,
) -> Result<(), DebugViewError> {
    let limits = device.limits();
    let bytes = view_uniform_bytes(views);
    // A debug view binds two uniform buffers, a texture and a sampler.
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
