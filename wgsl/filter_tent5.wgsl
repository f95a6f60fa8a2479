// Applies the kernel [1 3 4 3 1] per axis to bilinear comparisons: 6x6 texels in nine gathers. The reach is three
// texels. The kernel is that of Castaño 2013, "Shadow Mapping Summary", here over raw depths, so that every texel has a
// reference depth of its own. CPU reference: src/receive/reference. Requires: view, texels, gather.
//
// The sum is written out and taken two rows at a time, as in `filter_tent3`.

// Returns the visibility of the light, in [0, 1].
fn shadow_filter_tent5(map: ShadowMap, map_sampler: sampler, receiver: ShadowReceiver) -> f32 {
    let kernel = shadow_kernel(receiver);
    let s = kernel.fraction.y;
    let upper = shadow_tent5_rows(map, map_sampler, receiver, kernel, -2.0);
    let middle = shadow_tent5_rows(map, map_sampler, receiver, kernel, 0.0);
    let lower = shadow_tent5_rows(map, map_sampler, receiver, kernel, 2.0);
    let sum = dot(upper, vec2<f32>(1.0 - s, 3.0 - 2.0 * s))
        + dot(middle, vec2<f32>(4.0 - s, 3.0 + s))
        + dot(lower, vec2<f32>(1.0 + 2.0 * s, s));
    return shadow_ramped(receiver, sum);
}

// Returns the weighted sums of the comparisons in rows `row` and `row + 1`, times twelve.
fn shadow_tent5_rows(
    map: ShadowMap,
    map_sampler: sampler,
    receiver: ShadowReceiver,
    kernel: ShadowKernel,
    row: f32,
) -> vec2<f32> {
    let s = kernel.fraction.x;
    let depths = shadow_texels_by_6(map, map_sampler, receiver, kernel.base + vec2<f32>(-1.0, row + 1.0));
    let rows = shadow_kernel_rows(receiver, kernel, row);
    return shadow_lit_rows(receiver, rows, -2.0, vec2<f32>(1.0 - s, 3.0 - 2.0 * s), depths[0])
        + shadow_lit_rows(receiver, rows, 0.0, vec2<f32>(4.0 - s, 3.0 + s), depths[1])
        + shadow_lit_rows(receiver, rows, 2.0, vec2<f32>(1.0 + 2.0 * s, s), depths[2]);
}
