// Applies the kernel [1 3 4 3 1] per axis to bilinear comparisons: 6x6 texels in nine gathers. The reach is three
// texels. The kernel is that of Castaño 2013, "Shadow Mapping Summary", here over raw depths, so that every texel has a
// reference depth of its own. CPU reference: src/receive/reference.rs. Requires: view, texels, gather.

// Returns the visibility of the light, in [0, 1].
fn shadow_filter_tent5(
    map: ShadowMap,
    map_sampler: sampler,
    receiver: ShadowReceiver,
) -> f32 {
    let from_centers = receiver.texel - 0.5;
    let base = floor(from_centers);
    let s = from_centers - base;
    let first = base - 2.0;
    let across = shadow_tent5_weights(s.x);
    let down = shadow_tent5_weights(s.y);
    // The sum is written out, since naga limits the iterations of a loop, and compilers do not unroll such a loop.
    let lit = shadow_tent5_rows(map, map_sampler, receiver, first, across, down[0])
        + shadow_tent5_rows(map, map_sampler, receiver, first + vec2<f32>(0.0, 2.0), across, down[1])
        + shadow_tent5_rows(map, map_sampler, receiver, first + vec2<f32>(0.0, 4.0), across, down[2]);
    return shadow_sharpen(lit / 144.0, receiver.sharpness);
}

// Returns the weights of three pairs of texels along an axis, times twelve.
fn shadow_tent5_weights(s: f32) -> mat3x2<f32> {
    return mat3x2<f32>(
        vec2<f32>(1.0 - s, 3.0 - 2.0 * s),
        vec2<f32>(4.0 - s, 3.0 + s),
        vec2<f32>(1.0 + 2.0 * s, s),
    );
}

// Returns the weighted sum of the comparisons of two rows of six texels.
fn shadow_tent5_rows(
    map: ShadowMap,
    map_sampler: sampler,
    receiver: ShadowReceiver,
    first: vec2<f32>,
    across: mat3x2<f32>,
    down: vec2<f32>,
) -> f32 {
    let left = shadow_gather(map, map_sampler, receiver, first);
    let middle = shadow_gather(map, map_sampler, receiver, first + vec2<f32>(2.0, 0.0));
    let right = shadow_gather(map, map_sampler, receiver, first + vec2<f32>(4.0, 0.0));
    return dot(left, vec4<f32>(across[0] * down.x, across[0] * down.y))
        + dot(middle, vec4<f32>(across[1] * down.x, across[1] * down.y))
        + dot(right, vec4<f32>(across[2] * down.x, across[2] * down.y));
}
