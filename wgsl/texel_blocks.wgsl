// Reads the blocks of 2x2 texels of a kernel, up to eight columns and rows of texels.
//
// `texels_by_offsets` replaces this module wherever it can, since it costs less: on all backends
// but OpenGL. Requires: view, texels.

// Return the four texels that lie so many columns to the right of those around `corner`, and so
// many rows below them.
fn shadow_texels_2_0(
    map: ShadowMap,
    map_sampler: sampler,
    receiver: ShadowReceiver,
    corner: vec2<f32>,
) -> vec4<f32> {
    return shadow_texels(map, map_sampler, receiver, corner + vec2<f32>(2.0, 0.0));
}
fn shadow_texels_4_0(
    map: ShadowMap,
    map_sampler: sampler,
    receiver: ShadowReceiver,
    corner: vec2<f32>,
) -> vec4<f32> {
    return shadow_texels(map, map_sampler, receiver, corner + vec2<f32>(4.0, 0.0));
}
fn shadow_texels_6_0(
    map: ShadowMap,
    map_sampler: sampler,
    receiver: ShadowReceiver,
    corner: vec2<f32>,
) -> vec4<f32> {
    return shadow_texels(map, map_sampler, receiver, corner + vec2<f32>(6.0, 0.0));
}
fn shadow_texels_0_2(
    map: ShadowMap,
    map_sampler: sampler,
    receiver: ShadowReceiver,
    corner: vec2<f32>,
) -> vec4<f32> {
    return shadow_texels(map, map_sampler, receiver, corner + vec2<f32>(0.0, 2.0));
}
fn shadow_texels_2_2(
    map: ShadowMap,
    map_sampler: sampler,
    receiver: ShadowReceiver,
    corner: vec2<f32>,
) -> vec4<f32> {
    return shadow_texels(map, map_sampler, receiver, corner + vec2<f32>(2.0, 2.0));
}
fn shadow_texels_4_2(
    map: ShadowMap,
    map_sampler: sampler,
    receiver: ShadowReceiver,
    corner: vec2<f32>,
) -> vec4<f32> {
    return shadow_texels(map, map_sampler, receiver, corner + vec2<f32>(4.0, 2.0));
}
fn shadow_texels_6_2(
    map: ShadowMap,
    map_sampler: sampler,
    receiver: ShadowReceiver,
    corner: vec2<f32>,
) -> vec4<f32> {
    return shadow_texels(map, map_sampler, receiver, corner + vec2<f32>(6.0, 2.0));
}
fn shadow_texels_0_4(
    map: ShadowMap,
    map_sampler: sampler,
    receiver: ShadowReceiver,
    corner: vec2<f32>,
) -> vec4<f32> {
    return shadow_texels(map, map_sampler, receiver, corner + vec2<f32>(0.0, 4.0));
}
fn shadow_texels_2_4(
    map: ShadowMap,
    map_sampler: sampler,
    receiver: ShadowReceiver,
    corner: vec2<f32>,
) -> vec4<f32> {
    return shadow_texels(map, map_sampler, receiver, corner + vec2<f32>(2.0, 4.0));
}
fn shadow_texels_4_4(
    map: ShadowMap,
    map_sampler: sampler,
    receiver: ShadowReceiver,
    corner: vec2<f32>,
) -> vec4<f32> {
    return shadow_texels(map, map_sampler, receiver, corner + vec2<f32>(4.0, 4.0));
}
fn shadow_texels_6_4(
    map: ShadowMap,
    map_sampler: sampler,
    receiver: ShadowReceiver,
    corner: vec2<f32>,
) -> vec4<f32> {
    return shadow_texels(map, map_sampler, receiver, corner + vec2<f32>(6.0, 4.0));
}
fn shadow_texels_0_6(
    map: ShadowMap,
    map_sampler: sampler,
    receiver: ShadowReceiver,
    corner: vec2<f32>,
) -> vec4<f32> {
    return shadow_texels(map, map_sampler, receiver, corner + vec2<f32>(0.0, 6.0));
}
fn shadow_texels_2_6(
    map: ShadowMap,
    map_sampler: sampler,
    receiver: ShadowReceiver,
    corner: vec2<f32>,
) -> vec4<f32> {
    return shadow_texels(map, map_sampler, receiver, corner + vec2<f32>(2.0, 6.0));
}
fn shadow_texels_4_6(
    map: ShadowMap,
    map_sampler: sampler,
    receiver: ShadowReceiver,
    corner: vec2<f32>,
) -> vec4<f32> {
    return shadow_texels(map, map_sampler, receiver, corner + vec2<f32>(4.0, 6.0));
}
fn shadow_texels_6_6(
    map: ShadowMap,
    map_sampler: sampler,
    receiver: ShadowReceiver,
    corner: vec2<f32>,
) -> vec4<f32> {
    return shadow_texels(map, map_sampler, receiver, corner + vec2<f32>(6.0, 6.0));
}
