// Moves the receiver along its normal by the least distance that prevents self-shadowing of a plane
// under any kernel.
//
// That distance is d = K * s * (|nx| + |ny|), with K the kernel's reach per axis in texels and the
// lateral error, s the world size of a texel and n the normal in light space. In a perspective view
// the texel grows with the distance of the offset point itself, which gives d / (1 - d'), with d'
// the offset per unit of view depth times the normal's component away from the light. The whole
// kernel is compared with one reference depth.
//
// CPU reference: src/receive/reference. Requires: view, place, raised_plane.

// Returns the receiver at `position` in a view of a directional light, moved along its geometric
// normal. Position and normal are in render space.
fn shadow_receiver_normal_offset_directional(
    view: ShadowViewUniform,
    position: vec3<f32>,
    normal: vec3<f32>,
) -> ShadowReceiver {
    let place = shadow_place_directional(view, position);
    let normal_light = shadow_light_from_render(view, normal);
    return shadow_normal_offset_directional(view, view.mapping, place, normal_light);
}

// Returns the receiver at `position` in a view of a local light, moved along its geometric normal.
// Position and normal are in render space.
fn shadow_receiver_normal_offset_local(
    view: ShadowViewUniform,
    position: vec3<f32>,
    normal: vec3<f32>,
) -> ShadowReceiver {
    let place = shadow_place_local(view, position);
    let normal_light = shadow_light_from_render(view, normal);
    return shadow_normal_offset_local(view, view.mapping, place, normal_light);
}

// Returns the receiver at a place of a directional light with a normal along the axes of light
// space.
fn shadow_normal_offset_directional(
    view: ShadowViewUniform,
    mapping: ShadowMapping,
    place: ShadowPlace,
    normal_light: vec3<f32>,
) -> ShadowReceiver {
    let across = abs(normal_light.xy) * mapping.texel_size;
    let offset = view.offset_texels * (across.x + across.y) + mapping.rounding;
    let texel = place.texel_from_middle + normal_light.xy * offset * mapping.texel_scale;
    let depth = place.depth + (mapping.depth_scale * (normal_light.z * offset) + view.depth_error);
    return shadow_receiver(view, mapping, place, texel, depth, vec2<f32>(0.0));
}

// Returns the receiver at a place of a local light with a normal along the axes of light space.
fn shadow_normal_offset_local(
    view: ShadowViewUniform,
    mapping: ShadowMapping,
    place: ShadowPlace,
    normal_light: vec3<f32>,
) -> ShadowReceiver {
    let height = dot(normal_light, place.position_light);
    let rounding = shadow_local_rounding(view, place, height);
    let across = abs(normal_light.xy) * mapping.texel_size;
    let per_w = view.offset_texels * (across.x + across.y);
    // This is the growth of w along the normal.
    let growth = per_w * max(-normal_light.z, 0.0);
    // Up to one half, 1 / (1 - growth) is at most 1 + 2 growth.
    let offset = per_w * -place.position_light.z * (1.0 + 2.0 * growth);
    // Where the kernel reaches past the horizon of the surface, no offset prevents self-shadowing.
    // Such a position is lit: its depth is set nearer than any in the map.
    let hopeless = !((growth < 0.5) & (offset + rounding < abs(height)));
    let plane = shadow_raised_plane(mapping, place, normal_light, height, rounding, offset);
    let texel = place.texel_from_middle + select(plane.shift, vec2<f32>(0.0), hopeless);
    let depth = select(plane.depth + view.depth_error, 2.0, hopeless);
    return shadow_receiver(view, mapping, place, texel, depth, vec2<f32>(0.0));
}
