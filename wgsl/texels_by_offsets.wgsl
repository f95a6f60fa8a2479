// Reads the blocks of 2x2 texels of a kernel as `texel_blocks` does, by gathers whose offsets are
// part of the instruction. OpenGL is the one backend on which this is not possible: naga writes no
// such gather of a depth texture for it. A composition that names this module includes it instead
// of `texel_blocks`. Requires: view, texels.

// Return the four texels that lie so many columns to the right of those around `corner`, and so
// many rows below them. WGSL takes the offset of a gather only as a constant, and constants keep
// registers free: sums of coordinates, which several gathers share, would be held until the last of
// them.
fn shadow_texels_2_0(
    map: ShadowMap,
    map_sampler: sampler,
    receiver: ShadowReceiver,
    corner: vec2<f32>,
) -> vec4<f32> {
    let uv = corner * receiver.uv_per_texel;
    return textureGather(map, map_sampler, uv, receiver.layer, vec2<i32>(2, 0)).wzxy;
}
fn shadow_texels_4_0(
    map: ShadowMap,
    map_sampler: sampler,
    receiver: ShadowReceiver,
    corner: vec2<f32>,
) -> vec4<f32> {
    let uv = corner * receiver.uv_per_texel;
    return textureGather(map, map_sampler, uv, receiver.layer, vec2<i32>(4, 0)).wzxy;
}
fn shadow_texels_6_0(
    map: ShadowMap,
    map_sampler: sampler,
    receiver: ShadowReceiver,
    corner: vec2<f32>,
) -> vec4<f32> {
    let uv = corner * receiver.uv_per_texel;
    return textureGather(map, map_sampler, uv, receiver.layer, vec2<i32>(6, 0)).wzxy;
}
fn shadow_texels_0_2(
    map: ShadowMap,
    map_sampler: sampler,
    receiver: ShadowReceiver,
    corner: vec2<f32>,
) -> vec4<f32> {
    let uv = corner * receiver.uv_per_texel;
    return textureGather(map, map_sampler, uv, receiver.layer, vec2<i32>(0, 2)).wzxy;
}
fn shadow_texels_2_2(
    map: ShadowMap,
    map_sampler: sampler,
    receiver: ShadowReceiver,
    corner: vec2<f32>,
) -> vec4<f32> {
    let uv = corner * receiver.uv_per_texel;
    return textureGather(map, map_sampler, uv, receiver.layer, vec2<i32>(2, 2)).wzxy;
}
fn shadow_texels_4_2(
    map: ShadowMap,
    map_sampler: sampler,
    receiver: ShadowReceiver,
    corner: vec2<f32>,
) -> vec4<f32> {
    let uv = corner * receiver.uv_per_texel;
    return textureGather(map, map_sampler, uv, receiver.layer, vec2<i32>(4, 2)).wzxy;
}
fn shadow_texels_6_2(
    map: ShadowMap,
    map_sampler: sampler,
    receiver: ShadowReceiver,
    corner: vec2<f32>,
) -> vec4<f32> {
    let uv = corner * receiver.uv_per_texel;
    return textureGather(map, map_sampler, uv, receiver.layer, vec2<i32>(6, 2)).wzxy;
}
fn shadow_texels_0_4(
    map: ShadowMap,
    map_sampler: sampler,
    receiver: ShadowReceiver,
    corner: vec2<f32>,
) -> vec4<f32> {
    let uv = corner * receiver.uv_per_texel;
    return textureGather(map, map_sampler, uv, receiver.layer, vec2<i32>(0, 4)).wzxy;
}
fn shadow_texels_2_4(
    map: ShadowMap,
    map_sampler: sampler,
    receiver: ShadowReceiver,
    corner: vec2<f32>,
) -> vec4<f32> {
    let uv = corner * receiver.uv_per_texel;
    return textureGather(map, map_sampler, uv, receiver.layer, vec2<i32>(2, 4)).wzxy;
}
fn shadow_texels_4_4(
    map: ShadowMap,
    map_sampler: sampler,
    receiver: ShadowReceiver,
    corner: vec2<f32>,
) -> vec4<f32> {
    let uv = corner * receiver.uv_per_texel;
    return textureGather(map, map_sampler, uv, receiver.layer, vec2<i32>(4, 4)).wzxy;
}
fn shadow_texels_6_4(
    map: ShadowMap,
    map_sampler: sampler,
    receiver: ShadowReceiver,
    corner: vec2<f32>,
) -> vec4<f32> {
    let uv = corner * receiver.uv_per_texel;
    return textureGather(map, map_sampler, uv, receiver.layer, vec2<i32>(6, 4)).wzxy;
}
fn shadow_texels_0_6(
    map: ShadowMap,
    map_sampler: sampler,
    receiver: ShadowReceiver,
    corner: vec2<f32>,
) -> vec4<f32> {
    let uv = corner * receiver.uv_per_texel;
    return textureGather(map, map_sampler, uv, receiver.layer, vec2<i32>(0, 6)).wzxy;
}
fn shadow_texels_2_6(
    map: ShadowMap,
    map_sampler: sampler,
    receiver: ShadowReceiver,
    corner: vec2<f32>,
) -> vec4<f32> {
    let uv = corner * receiver.uv_per_texel;
    return textureGather(map, map_sampler, uv, receiver.layer, vec2<i32>(2, 6)).wzxy;
}
fn shadow_texels_4_6(
    map: ShadowMap,
    map_sampler: sampler,
    receiver: ShadowReceiver,
    corner: vec2<f32>,
) -> vec4<f32> {
    let uv = corner * receiver.uv_per_texel;
    return textureGather(map, map_sampler, uv, receiver.layer, vec2<i32>(4, 6)).wzxy;
}
fn shadow_texels_6_6(
    map: ShadowMap,
    map_sampler: sampler,
    receiver: ShadowReceiver,
    corner: vec2<f32>,
) -> vec4<f32> {
    let uv = corner * receiver.uv_per_texel;
    return textureGather(map, map_sampler, uv, receiver.layer, vec2<i32>(6, 6)).wzxy;
}
