// Describes the six depth renders of a point light's cube, which are drawn in one multiview pass.
// It replaces `caster` in such a pass.
//
// CPU counterpart: src/cast/view_uniform.rs.

struct ShadowCasterFace {
    // Transforms coordinates relative to the anchor to clip space (reversed depth: near 1, far 0).
    clip_from_anchor: mat4x4<f32>,
    // Is the light's position in render space.
    anchor: vec3<f32>,
    // Is the number of texels per side of the map.
    map_size: f32,
}

@group(0) @binding(0) var<uniform> shadow_caster_faces: array<ShadowCasterFace, 6>;

// Returns the value for @builtin(position) on one face of a vertex at `position` in render space.
// The arithmetic is that of `shadow_caster_clip`, so that both ways give the same depths.
fn shadow_caster_face_clip(face: u32, position: vec3<f32>) -> vec4<f32> {
    let relative = position - shadow_caster_faces[face].anchor;
    return shadow_caster_faces[face].clip_from_anchor * vec4<f32>(relative, 1.0);
}
