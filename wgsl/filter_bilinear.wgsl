// Gathered 2x2 texels, bilinearly weighted in full precision. Reach: one texel.
// Rust twin: src/receive/reference.rs. Requires: view, texels, gather.

fn shadow_filter_bilinear(
    map: ShadowMap,
    map_sampler: sampler,
    receiver: ShadowReceiver,
) -> f32 {
    let from_centers = receiver.texel - 0.5;
    let first = floor(from_centers);
    let s = from_centers - first;
    let lit = shadow_gather(map, map_sampler, receiver, first);
    let rows = mix(lit.xz, lit.yw, s.x);
    return shadow_sharpen(mix(rows.x, rows.y, s.y), receiver.sharpness);
}
