// Compares 2x2 gathered texels and weights the results bilinearly in full precision. The reach is one texel.
// CPU reference: src/receive/reference.rs. Requires: view, texels, gather.

// Returns the visibility of the light, in [0, 1].
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
