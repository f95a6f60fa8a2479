// One texel, one comparison. Reach: half a texel. Rust twin: src/receive/reference.rs. Requires: view.

fn shadow_filter_nearest(map: texture_depth_2d_array, receiver: ShadowReceiver) -> f32 {
    let texel = floor(receiver.texel);
    let rise = dot(receiver.gradient, texel + 0.5 - receiver.texel);
    let depth = textureLoad(map, vec2<i32>(texel), receiver.layer, 0);
    return select(0.0, 1.0, receiver.depth + max(rise, 0.0) >= depth);
}
