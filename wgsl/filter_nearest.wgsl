// One texel, one comparison. Reach: half a texel. Rust twin: src/receive/reference.rs. Requires: view, texels, gather.

fn shadow_filter_nearest(
    map: ShadowMap,
    map_sampler: sampler,
    receiver: ShadowReceiver,
) -> f32 {
    return shadow_gather(map, map_sampler, receiver, floor(receiver.texel)).x;
}
