// Filters as `filter_pcss` does, with sample patterns that are rotated by another angle for each
// half texel. Noise then replaces banding where a penumbra is so wide that its samples lie far
// apart. The noise is fixed in the world, since the angle follows from the texel's position in a
// grid that is fixed in the world. CPU reference: src/receive/reference. Requires: view, texels,
// filter_pcss.

// Returns the visibility of the light, in [0, 1].
fn shadow_filter_pcss_rotated(
    map: ShadowMap,
    map_sampler: sampler,
    receiver: ShadowReceiver,
) -> f32 {
    let first = vec2<u32>(receiver.grid & 0xffffu, receiver.grid >> 16u);
    let half_texel = vec2<u32>(max(receiver.texel, vec2<f32>(0.0)) * 2.0) + first * 2u;
    let angle = f32(shadow_hash(half_texel & vec2<u32>(0x1ffffu)) >> 8u) * (6.2831853 / 16777216.0);
    let turn = mat2x2<f32>(cos(angle), sin(angle), -sin(angle), cos(angle));
    return shadow_penumbra(map, map_sampler, receiver, turn);
}

// Returns a hash of 32 bits of a cell. The two numbers of the cell are joined by a prime near 2^32
// divided by the golden ratio and by one of xxHash (Collet 2012); the finaliser is "lowbias32"
// (Wellons 2018).
fn shadow_hash(cell: vec2<u32>) -> u32 {
    var bits = (cell.x * 0x9e3779b1u) ^ (cell.y * 0x85ebca77u);
    bits = (bits ^ (bits >> 16u)) * 0x7feb352du;
    bits = (bits ^ (bits >> 15u)) * 0x846ca68bu;
    return bits ^ (bits >> 16u);
}
