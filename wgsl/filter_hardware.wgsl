// Uses the sampler's own 2x2 comparison, which is bilinearly weighted; its weights have as few as
// four bits. Four texels share one reference depth, so the gradient is not used. The reach is one
// texel. CPU reference: src/receive/reference. Requires: view.

// Returns the visibility of the light, in [0, 1].
fn shadow_filter_hardware(
    map: texture_depth_2d_array,
    map_sampler: sampler_comparison,
    receiver: ShadowReceiver,
) -> f32 {
    let uv = receiver.texel * receiver.uv_per_texel;
    return textureSampleCompareLevel(map, map_sampler, uv, receiver.layer, receiver.depth);
}
