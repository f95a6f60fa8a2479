// The textbook's 3x3 percentage-closer filter: the mean of nine nearest comparisons one texel apart, in steps of a ninth, out
// of four gathers. Reach: one and a half texels. Rust twin: src/receive/reference.rs. Requires: view, texels, gather.

fn shadow_filter_box(
    map: ShadowMap,
    map_sampler: sampler,
    receiver: ShadowReceiver,
) -> f32 {
    let first = floor(receiver.texel) - 1.0;
    let near = shadow_gather(map, map_sampler, receiver, first);
    let right = shadow_gather(map, map_sampler, receiver, first + vec2<f32>(2.0, 0.0));
    let below = shadow_gather(map, map_sampler, receiver, first + vec2<f32>(0.0, 2.0));
    let corner = shadow_gather(map, map_sampler, receiver, first + 2.0);
    return (dot(near, vec4<f32>(1.0)) + right.x + right.z + below.x + below.y + corner.x) / 9.0;
}
