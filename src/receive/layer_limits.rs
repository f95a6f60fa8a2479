//! Checks that a device's limits suffice for the maps of a light.

use crate::ShadowError;
use crate::cast::{VIEW_UNIFORM_BYTES, caster_group, shared_layer_group};
use crate::gpu::{Need, allocated_layers};
use crate::receive::view_uniform_bytes;

/// Accepts devices whose limits suffice for a light with `views` views, in one layer that they
/// share or in a layer each. `field` is the path of the field that sets their number.
pub(crate) fn check_layers(
    device: &wgpu::Device,
    field: &'static str,
    shares_layer: bool,
    views: u64,
) -> Result<(), ShadowError> {
    let limits = device.limits();
    let layers = if shares_layer { 1 } else { views };
    let uniform_bytes = view_uniform_bytes(views);
    let alignment = u64::from(limits.min_uniform_buffer_offset_alignment);
    let caster_bytes = VIEW_UNIFORM_BYTES.next_multiple_of(alignment) * views;
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
    let shared = shares_layer.then(|| shared_layer_group(&limits));
    let passes = caster_group(&limits);
    let passes = passes.into_iter().chain(shared.into_iter().flatten());
    Need::first_unmet(passes).map_or(Ok(()), over("the depth pass of a light"))
}
