// Bias by moving the receiver along its normal, by the least distance that frees a plane of self-shadowing under any kernel.
//
// d = (K + lateral error) * s * (|nx| + |ny|), K the kernel's reach per axis in texels, s the world size of a texel; for a
// perspective view the texel grows with the offset point's own distance: d / (1 - d'), d' the offset per unit of view depth
// times the normal's component away from the light. One reference depth serves the whole kernel.
// Rust twin: src/receive/reference.rs. Requires: view.

fn shadow_receiver_normal_offset(
    view: ShadowView,
    position: vec3<f32>,
    normal: vec3<f32>,
) -> ShadowReceiver {
    let relative = shadow_clear_of_rounding(view, position - view.anchor, normal);
    let plane = shadow_plane(view, relative, normal);
    let texels = view.offset_texels + view.lateral_error;
    let offset = shadow_normal_offset(view, relative, plane, texels);
    // Growth of w along the normal: zero for an orthographic view.
    let growth = texels * (abs(plane.x) + abs(plane.y)) * max(dot(shadow_w_row(view).xyz, normal), 0.0);
    let distance = offset / (1.0 - min(growth, 0.9)) + shadow_rounding_offset(view);
    // Where the kernel spans the surface's horizon no offset frees it: such a place is lit, by a depth nearer than any map's.
    let hopeless = (growth >= 0.9) | (distance >= shadow_light_height(view, relative, normal));
    let moved = relative + normal * select(0.0, distance, (distance > 0.0) & !hopeless);
    let depth_offset = select(view.depth_error, 2.0, hopeless);
    return shadow_receiver_at(view, position, moved, vec2<f32>(0.0), depth_offset);
}
