// The textbook's 3x3 percentage-closer filter: the mean of nine nearest comparisons one texel apart, in steps of a ninth.
// Reach: one and a half texels. Rust twin: src/receive/reference.rs. Requires: view.

fn shadow_filter_box(map: texture_depth_2d_array, receiver: ShadowReceiver) -> f32 {
    let middle = floor(receiver.texel);
    var lit = 0.0;
    for (var y = -1; y <= 1; y++) {
        for (var x = -1; x <= 1; x++) {
            let texel = middle + vec2<f32>(f32(x), f32(y));
            let rise = dot(receiver.gradient, texel + 0.5 - receiver.texel);
            let depth = textureLoad(map, vec2<i32>(texel), receiver.layer, 0);
            lit += select(0.0, 1.0, receiver.depth + max(rise, 0.0) >= depth);
        }
    }
    return lit / 9.0;
}
