// One texel, one comparison. Reach: half a texel. Rust twin: src/receive/reference.rs. Requires: view, gather.

fn shadow_filter_nearest(
    map: texture_depth_2d_array,
    map_sampler: sampler,
    receiver: ShadowReceiver,
) -> f32 {
    // A gather and not a load: GLSL cannot load from a depth texture.
    return shadow_gather(map, map_sampler, receiver, floor(receiver.texel)).x;
}
