// Compares with one texel. The reach is half a texel.
// CPU reference: src/receive/reference. Requires: view, texels, gather.

// Returns 1 where the receiver is lit, and 0 where it is shadowed.
fn shadow_filter_nearest(
    map: ShadowMap,
    map_sampler: sampler,
    receiver: ShadowReceiver,
) -> f32 {
    return shadow_gather(map, map_sampler, receiver, floor(receiver.texel)).x;
}
