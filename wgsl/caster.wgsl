// Describes the depth render that a caster is drawn into. This module precedes the vertex stage of
// every caster.
//
// CPU counterpart: src/cast/view_uniform.rs.

struct ShadowCasterView {
    // Transforms coordinates relative to the anchor to clip space (reversed depth: near 1, far 0).
    clip_from_anchor: mat4x4<f32>,
    // Is a point of render space inside the view; for a local light, the light's position.
    anchor: vec3<f32>,
    // Is the number of texels per side of the map.
    map_size: f32,
}

@group(0) @binding(0) var<uniform> shadow_caster_view: ShadowCasterView;

// Returns the value for @builtin(position) of a vertex at `position` in render space.
fn shadow_caster_clip(position: vec3<f32>) -> vec4<f32> {
    let relative = position - shadow_caster_view.anchor;
    return shadow_caster_view.clip_from_anchor * vec4<f32>(relative, 1.0);
}
