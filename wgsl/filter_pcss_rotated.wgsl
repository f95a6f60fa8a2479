// `filter_pcss` with its patterns turned by an angle of each half texel's own: grain in place of bands where a penumbra is
// so wide that its taps lie far apart. The grain stands still in the world, since a texel's place in the world's grid makes the
// angle. Rust twin: src/receive/reference.rs. Requires: view, texels, filter_pcss.

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

// 32 well mixed bits of a cell: primes near 2^32 times the golden ratio and of xxHash (Collet 2012) join its two numbers, and
// the finaliser is "lowbias32" (Wellons 2018).
fn shadow_hash(cell: vec2<u32>) -> u32 {
    var bits = (cell.x * 0x9e3779b1u) ^ (cell.y * 0x85ebca77u);
    bits = (bits ^ (bits >> 16u)) * 0x7feb352du;
    bits = (bits ^ (bits >> 15u)) * 0x846ca68bu;
    return bits ^ (bits >> 16u);
}
