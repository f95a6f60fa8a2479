// The depth render that a caster is drawn into. Put before every caster's vertex stage.
//
// Rust twin: src/cast/recorder.rs.

struct ShadowCasterView {
    // Clip space (reversed depth: near 1, far 0) from coordinates relative to the anchor.
    clip_from_anchor: mat4x4<f32>,
    anchor: vec3<f32>,
    // Texels per side.
    map_size: f32,
}

@group(0) @binding(0) var<uniform> shadow_caster_view: ShadowCasterView;

// The value for @builtin(position) of a vertex at `position` in render space.
fn shadow_caster_clip(position: vec3<f32>) -> vec4<f32> {
    let relative = position - shadow_caster_view.anchor;
    return shadow_caster_view.clip_from_anchor * vec4<f32>(relative, 1.0);
}
