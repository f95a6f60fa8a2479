// Applies the manual bias of the tutorial at learnopengl.com: max(slope * (1 - n · l), constant), in world units toward
// the light.
//
// CPU reference: src/receive/reference.rs. Requires: view.

// Returns the receiver at `position` (render space), moved toward the light by the manual bias.
fn shadow_receiver_manual(view: ShadowViewUniform, position: vec3<f32>, normal: vec3<f32>) -> ShadowReceiver {
    let relative = position - view.anchor;
    let toward_light = normalize(select(view.light.xyz, -relative, view.light.w > 0.0));
    let facing = dot(normal, toward_light);
    let distance = max(view.manual_slope * (1.0 - facing), view.manual_constant);
    let moved = relative + toward_light * distance;
    return shadow_receiver_at(view, position, moved, vec2<f32>(0.0), 0.0);
}
