// The six depth renders of a point light's cube, drawn in one pass. Takes the place of `caster` where the device draws several
// views at once.
//
// Rust twin: src/cast/recorder.rs.

struct ShadowCasterFace {
    // Clip space (reversed depth: near 1, far 0) from coordinates relative to the anchor.
    clip_from_anchor: mat4x4<f32>,
    anchor: vec3<f32>,
    // Texels per side.
    map_size: f32,
}

@group(0) @binding(0) var<uniform> shadow_caster_faces: array<ShadowCasterFace, 6>;

// The value for @builtin(position) on one face of a vertex at `position` in render space: the same arithmetic as
// `shadow_caster_clip`, so that both ways give the same depths.
fn shadow_caster_face_clip(face: u32, position: vec3<f32>) -> vec4<f32> {
    let relative = position - shadow_caster_faces[face].anchor;
    return shadow_caster_faces[face].clip_from_anchor * vec4<f32>(relative, 1.0);
}
