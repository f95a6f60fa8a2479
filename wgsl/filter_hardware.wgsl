// The sampler's own 2x2 comparison, bilinearly weighted; its weights have as few as four bits. One reference serves four
// texels, so the gradient is not used. Reach: one texel. Rust twin: src/receive/reference.rs. Requires: view.

fn shadow_filter_hardware(
    map: texture_depth_2d_array,
    map_sampler: sampler_comparison,
    receiver: ShadowReceiver,
) -> f32 {
    let uv = receiver.texel / receiver.map_size;
    return textureSampleCompareLevel(map, map_sampler, uv, receiver.layer, receiver.depth);
}
