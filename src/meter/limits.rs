//! Checks that a device's limits suffice for an error meter.

use crate::ShadowError;
use crate::cast::VIEW_UNIFORM_BYTES;
use crate::gpu::{Need, allocated_layers};
use crate::meter::lookup::{RESULT_BYTES, WORKGROUP_SIZE};
use crate::meter::places::{PlaceUniform, RAYS_PER_PLACE};

/// Accepts devices with compute shaders whose limits suffice for `places` places, whose number
/// comes from the field of this path. WebGL 2 has no compute shaders.
pub(super) fn check_limits(
    device: &wgpu::Device,
    field: &'static str,
    places: u32,
) -> Result<(), ShadowError> {
    let limits = device.limits();
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
    let pass = [
        Need::new(
            "max_compute_invocations_per_workgroup",
            WORKGROUP_SIZE,
            limits.max_compute_invocations_per_workgroup,
        ),
        Need::new(
            "max_compute_workgroup_size_x",
            WORKGROUP_SIZE,
            limits.max_compute_workgroup_size_x,
        ),
        Need::new(
            "max_storage_buffers_per_shader_stage",
            2u32,
            limits.max_storage_buffers_per_shader_stage,
        ),
        // The light's map and the texels of the rays each have a sampler.
        Need::new(
            "max_sampled_textures_per_shader_stage",
            2u32,
            limits.max_sampled_textures_per_shader_stage,
        ),
        Need::new(
            "max_samplers_per_shader_stage",
            2u32,
            limits.max_samplers_per_shader_stage,
        ),
        Need::new("max_bind_groups", 2u32, limits.max_bind_groups),
        Need::new(
            "max_bindings_per_bind_group",
            4u32,
            limits.max_bindings_per_bind_group,
        ),
        Need::new(
            "max_texture_array_layers",
            allocated_layers(device, 1),
            limits.max_texture_array_layers,
        ),
    ];
    Need::first_unmet(pass).map_or(Ok(()), over("the compute pass of an ErrorMeter"))?;
    let place_bytes = RESULT_BYTES.max(size_of::<PlaceUniform>() as u64);
    let alignment = u64::from(limits.min_uniform_buffer_offset_alignment);
    let ray_bytes = VIEW_UNIFORM_BYTES.next_multiple_of(alignment) * RAYS_PER_PLACE as u64;
    let of_places = [
        Need::new(
            "max_compute_workgroups_per_dimension",
            places.div_ceil(WORKGROUP_SIZE),
            limits.max_compute_workgroups_per_dimension,
        ),
        Need::new(
            "max_storage_buffer_binding_size",
            place_bytes * u64::from(places),
            limits.max_storage_buffer_binding_size,
        ),
        Need::new(
            "max_buffer_size",
            place_bytes.max(ray_bytes) * u64::from(places),
            limits.max_buffer_size,
        ),
    ];
    Need::first_unmet(of_places).map_or(Ok(()), over(field))
}
