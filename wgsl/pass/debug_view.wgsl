// One layer of a depth map as grey levels: black at the light's near plane, white at the far plane and where nothing casts.

struct ShadowDebugView {
    layer: u32,
    map_size: f32,
}

@group(0) @binding(0) var<uniform> shadow_debug: ShadowDebugView;
@group(0) @binding(1) var shadow_debug_map: texture_depth_2d_array;

struct ShadowDebugVertex {
    @builtin(position) clip: vec4<f32>,
    @location(0) uv: vec2<f32>,
}

@vertex
fn shadow_debug_vertex(@builtin(vertex_index) index: u32) -> ShadowDebugVertex {
    // One triangle over the whole viewport.
    let corner = vec2<f32>(f32(index & 1u), f32(index >> 1u)) * 2.0;
    var vertex: ShadowDebugVertex;
    vertex.clip = vec4<f32>(corner.x * 2.0 - 1.0, 1.0 - corner.y * 2.0, 0.0, 1.0);
    vertex.uv = corner;
    return vertex;
}

@fragment
fn shadow_debug_fragment(vertex: ShadowDebugVertex) -> @location(0) vec4<f32> {
    let last = shadow_debug.map_size - 1.0;
    let texel = clamp(floor(vertex.uv * shadow_debug.map_size), vec2<f32>(0.0), vec2<f32>(last));
    let depth = textureLoad(shadow_debug_map, vec2<i32>(texel), shadow_debug.layer, 0);
    // An orthographic depth is linear in distance; reversed, so that near is dark.
    return vec4<f32>(vec3<f32>(1.0 - depth), 1.0);
}
