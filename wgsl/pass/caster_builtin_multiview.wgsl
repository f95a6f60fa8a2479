// Contains the built-in vertex stages of casters for six faces in one multiview pass. Requires:
// caster_multiview.

// Draws positions that are in render space already.
@vertex
fn shadow_caster_vertex_identity(
    @builtin(view_index) face: u32,
    @location(0) position: vec3<f32>,
) -> @builtin(position) vec4<f32> {
    return shadow_caster_face_clip(face, position);
}

// Draws positions that an instance's matrix transforms to render space.
@vertex
fn shadow_caster_vertex_instance(
    @builtin(view_index) face: u32,
    @location(0) position: vec3<f32>,
    @location(1) column_x: vec4<f32>,
    @location(2) column_y: vec4<f32>,
    @location(3) column_z: vec4<f32>,
    @location(4) column_w: vec4<f32>,
) -> @builtin(position) vec4<f32> {
    let render_from_model = mat4x4<f32>(column_x, column_y, column_z, column_w);
    return shadow_caster_face_clip(face, (render_from_model * vec4<f32>(position, 1.0)).xyz);
}
