// Contains the vertex stage of passes that cover a whole viewport.

struct ShadowFullscreenVertex {
    @builtin(position) clip: vec4<f32>,
    @location(0) uv: vec2<f32>,
}

// Returns the corners of one triangle that covers the whole viewport; uv has its origin at the top
// left.
@vertex
fn shadow_fullscreen_vertex(@builtin(vertex_index) index: u32) -> ShadowFullscreenVertex {
    let corner = vec2<f32>(f32(index & 1u), f32(index >> 1u)) * 2.0;
    var vertex: ShadowFullscreenVertex;
    vertex.clip = vec4<f32>(corner.x * 2.0 - 1.0, 1.0 - corner.y * 2.0, 0.0, 1.0);
    vertex.uv = corner;
    return vertex;
}
