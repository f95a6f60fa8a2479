// Reads raw depths of a map by gathers, four texels at once.
//
// `texels_by_offsets` replaces this module wherever it can, since it costs less: everywhere but in
// OpenGL. Where shaders cannot gather at all (GLSL ES 3.0: OpenGL ES 3.0 and WebGL 2),
// `texels_by_samples` does. Requires: view.
//
// A gather samples at the corner where four texels meet. Every position that selects other texels
// is half a texel away, so rounding cannot select them. It returns the texels counter-clockwise
// from the lower left; here they are in the order of rows: upper left, upper right, lower left,
// lower right. Beyond the sides of the map they are those of the nearest texel inside.

// Is the type of a map for the filters that compare each texel.
alias ShadowMap = texture_depth_2d_array;

// Returns the four texels around `corner`, in texel coordinates.
fn shadow_texels(map: ShadowMap, map_sampler: sampler, receiver: ShadowReceiver, corner: vec2<f32>) -> vec4<f32> {
    return textureGather(map, map_sampler, corner * receiver.uv_per_texel, receiver.layer).wzxy;
}

// Return the four texels that lie so many columns to the right of those around `corner`, and so
// many rows below them.
fn shadow_texels_2_0(map: ShadowMap, map_sampler: sampler, receiver: ShadowReceiver, corner: vec2<f32>) -> vec4<f32> {
    return shadow_texels(map, map_sampler, receiver, corner + vec2<f32>(2.0, 0.0));
}
fn shadow_texels_4_0(map: ShadowMap, map_sampler: sampler, receiver: ShadowReceiver, corner: vec2<f32>) -> vec4<f32> {
    return shadow_texels(map, map_sampler, receiver, corner + vec2<f32>(4.0, 0.0));
}
fn shadow_texels_6_0(map: ShadowMap, map_sampler: sampler, receiver: ShadowReceiver, corner: vec2<f32>) -> vec4<f32> {
    return shadow_texels(map, map_sampler, receiver, corner + vec2<f32>(6.0, 0.0));
}
fn shadow_texels_0_2(map: ShadowMap, map_sampler: sampler, receiver: ShadowReceiver, corner: vec2<f32>) -> vec4<f32> {
    return shadow_texels(map, map_sampler, receiver, corner + vec2<f32>(0.0, 2.0));
}
fn shadow_texels_2_2(map: ShadowMap, map_sampler: sampler, receiver: ShadowReceiver, corner: vec2<f32>) -> vec4<f32> {
    return shadow_texels(map, map_sampler, receiver, corner + vec2<f32>(2.0, 2.0));
}
fn shadow_texels_4_2(map: ShadowMap, map_sampler: sampler, receiver: ShadowReceiver, corner: vec2<f32>) -> vec4<f32> {
    return shadow_texels(map, map_sampler, receiver, corner + vec2<f32>(4.0, 2.0));
}
fn shadow_texels_6_2(map: ShadowMap, map_sampler: sampler, receiver: ShadowReceiver, corner: vec2<f32>) -> vec4<f32> {
    return shadow_texels(map, map_sampler, receiver, corner + vec2<f32>(6.0, 2.0));
}
fn shadow_texels_0_4(map: ShadowMap, map_sampler: sampler, receiver: ShadowReceiver, corner: vec2<f32>) -> vec4<f32> {
    return shadow_texels(map, map_sampler, receiver, corner + vec2<f32>(0.0, 4.0));
}
fn shadow_texels_2_4(map: ShadowMap, map_sampler: sampler, receiver: ShadowReceiver, corner: vec2<f32>) -> vec4<f32> {
    return shadow_texels(map, map_sampler, receiver, corner + vec2<f32>(2.0, 4.0));
}
fn shadow_texels_4_4(map: ShadowMap, map_sampler: sampler, receiver: ShadowReceiver, corner: vec2<f32>) -> vec4<f32> {
    return shadow_texels(map, map_sampler, receiver, corner + vec2<f32>(4.0, 4.0));
}
fn shadow_texels_6_4(map: ShadowMap, map_sampler: sampler, receiver: ShadowReceiver, corner: vec2<f32>) -> vec4<f32> {
    return shadow_texels(map, map_sampler, receiver, corner + vec2<f32>(6.0, 4.0));
}
fn shadow_texels_0_6(map: ShadowMap, map_sampler: sampler, receiver: ShadowReceiver, corner: vec2<f32>) -> vec4<f32> {
    return shadow_texels(map, map_sampler, receiver, corner + vec2<f32>(0.0, 6.0));
}
fn shadow_texels_2_6(map: ShadowMap, map_sampler: sampler, receiver: ShadowReceiver, corner: vec2<f32>) -> vec4<f32> {
    return shadow_texels(map, map_sampler, receiver, corner + vec2<f32>(2.0, 6.0));
}
fn shadow_texels_4_6(map: ShadowMap, map_sampler: sampler, receiver: ShadowReceiver, corner: vec2<f32>) -> vec4<f32> {
    return shadow_texels(map, map_sampler, receiver, corner + vec2<f32>(4.0, 6.0));
}
fn shadow_texels_6_6(map: ShadowMap, map_sampler: sampler, receiver: ShadowReceiver, corner: vec2<f32>) -> vec4<f32> {
    return shadow_texels(map, map_sampler, receiver, corner + vec2<f32>(6.0, 6.0));
}
