// Applies the 3x3 percentage-closer filter of the tutorial at learnopengl.com: the mean of nine nearest comparisons one
// texel apart, in steps of a ninth, from four gathers. The reach is one and a half texels.
// CPU reference: src/receive/reference.rs. Requires: view, texels, gather.

// Returns the visibility of the light, in [0, 1].
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
