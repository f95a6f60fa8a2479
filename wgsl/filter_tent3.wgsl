// Applies the kernel [1 2 1] per axis to bilinear comparisons: 4x4 texels in four gathers. The reach is two texels. The
// kernel is that of Castaño 2013, "Shadow Mapping Summary", here over raw depths, so that every texel has a reference
// depth of its own. CPU reference: src/receive/reference.rs. Requires: view, texels, gather.

// Returns the visibility of the light, in [0, 1].
fn shadow_filter_tent3(
    map: ShadowMap,
    map_sampler: sampler,
    receiver: ShadowReceiver,
) -> f32 {
    let from_centers = receiver.texel - 0.5;
    let base = floor(from_centers);
    let s = from_centers - base;
    let first = base - 1.0;
    // These are the weights of pairs of texels along each axis, times four. The sum is written out, since naga limits
    // the iterations of a loop, and compilers do not unroll such a loop.
    let left = vec2<f32>(1.0 - s.x, 2.0 - s.x);
    let right = vec2<f32>(1.0 + s.x, s.x);
    let upper = vec2<f32>(1.0 - s.y, 2.0 - s.y);
    let lower = vec2<f32>(1.0 + s.y, s.y);
    let lit = dot(shadow_gather(map, map_sampler, receiver, first), vec4<f32>(left * upper.x, left * upper.y))
        + dot(shadow_gather(map, map_sampler, receiver, first + vec2<f32>(2.0, 0.0)), vec4<f32>(right * upper.x, right * upper.y))
        + dot(shadow_gather(map, map_sampler, receiver, first + vec2<f32>(0.0, 2.0)), vec4<f32>(left * lower.x, left * lower.y))
        + dot(shadow_gather(map, map_sampler, receiver, first + 2.0), vec4<f32>(right * lower.x, right * lower.y));
    return shadow_sharpen(lit / 16.0, receiver.sharpness);
}
