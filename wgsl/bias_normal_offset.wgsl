// Moves the receiver along its normal by the least distance that prevents self-shadowing of a plane under any kernel.
//
// That distance is d = (K + lateral error) * s * (|nx| + |ny|), with K the kernel's reach per axis in texels, s the
// world size of a texel and n the normal in light space. In a perspective view the texel grows with the distance of the
// offset point itself, which gives d / (1 - d'), with d' the offset per unit of view depth times the normal's component
// away from the light. The whole kernel is compared with one reference depth.
//
// CPU reference: src/receive/reference.rs. Requires: view.

// Returns the receiver at `position` (render space), moved along its geometric normal.
fn shadow_receiver_normal_offset(
    view: ShadowViewUniform,
    position: vec3<f32>,
    normal: vec3<f32>,
) -> ShadowReceiver {
    let relative = shadow_clear_of_rounding(view, position - view.anchor, normal);
    let plane = shadow_plane(view, relative, normal);
    let texels = view.offset_texels + view.lateral_error;
    let offset = shadow_normal_offset(view, relative, plane, texels);
    // This is the growth of w along the normal, which is zero for an orthographic view.
    let growth = texels * (abs(plane.x) + abs(plane.y)) * max(dot(shadow_w_row(view).xyz, normal), 0.0);
    let distance = offset / (1.0 - min(growth, 0.9)) + shadow_rounding_offset(view);
    // Where the kernel reaches past the horizon of the surface, no offset prevents self-shadowing. Such a position is
    // lit: its depth is set nearer than any in the map.
    let hopeless = (growth >= 0.9) | (distance >= shadow_light_height(view, relative, normal));
    let moved = relative + normal * select(0.0, distance, (distance > 0.0) & !hopeless);
    let depth_offset = select(view.depth_error, 2.0, hopeless);
    return shadow_receiver_at(view, position, moved, vec2<f32>(0.0), depth_offset);
}
