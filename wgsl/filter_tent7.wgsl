// Applies the kernel [1 5 12 16 12 5 1] per axis to bilinear comparisons: 8x8 texels in sixteen gathers. The reach is
// four texels. The kernel is that of Castaño 2013, "Shadow Mapping Summary", here over raw depths, so that every texel
// has a reference depth of its own. CPU reference: src/receive/reference.rs. Requires: view, texels, gather.

// Returns the visibility of the light, in [0, 1].
fn shadow_filter_tent7(
    map: ShadowMap,
    map_sampler: sampler,
    receiver: ShadowReceiver,
) -> f32 {
    let from_centers = receiver.texel - 0.5;
    let base = floor(from_centers);
    let s = from_centers - base;
    let first = base - 3.0;
    let across = shadow_tent7_weights(s.x);
    let down = shadow_tent7_weights(s.y);
    // The sum is written out, since naga limits the iterations of a loop, and compilers do not unroll such a loop.
    let lit = shadow_tent7_rows(map, map_sampler, receiver, first, across, down[0])
        + shadow_tent7_rows(map, map_sampler, receiver, first + vec2<f32>(0.0, 2.0), across, down[1])
        + shadow_tent7_rows(map, map_sampler, receiver, first + vec2<f32>(0.0, 4.0), across, down[2])
        + shadow_tent7_rows(map, map_sampler, receiver, first + vec2<f32>(0.0, 6.0), across, down[3]);
    return shadow_sharpen(lit / 2704.0, receiver.sharpness);
}

// Returns the weights of four pairs of texels along an axis, times fifty-two.
fn shadow_tent7_weights(s: f32) -> mat4x2<f32> {
    return mat4x2<f32>(
        vec2<f32>(1.0 - s, 5.0 - 4.0 * s),
        vec2<f32>(12.0 - 7.0 * s, 16.0 - 4.0 * s),
        vec2<f32>(12.0 + 4.0 * s, 5.0 + 7.0 * s),
        vec2<f32>(1.0 + 4.0 * s, s),
    );
}

// Returns the weighted sum of the comparisons of two rows of eight texels.
fn shadow_tent7_rows(
    map: ShadowMap,
    map_sampler: sampler,
    receiver: ShadowReceiver,
    first: vec2<f32>,
    across: mat4x2<f32>,
    down: vec2<f32>,
) -> f32 {
    let outer_left = shadow_gather(map, map_sampler, receiver, first);
    let left = shadow_gather(map, map_sampler, receiver, first + vec2<f32>(2.0, 0.0));
    let right = shadow_gather(map, map_sampler, receiver, first + vec2<f32>(4.0, 0.0));
    let outer_right = shadow_gather(map, map_sampler, receiver, first + vec2<f32>(6.0, 0.0));
    return dot(outer_left, vec4<f32>(across[0] * down.x, across[0] * down.y))
        + dot(left, vec4<f32>(across[1] * down.x, across[1] * down.y))
        + dot(right, vec4<f32>(across[2] * down.x, across[2] * down.y))
        + dot(outer_right, vec4<f32>(across[3] * down.x, across[3] * down.y));
}
