// Applies the kernel [1 5 12 16 12 5 1] per axis to bilinear comparisons: 8x8 texels in sixteen gathers. The reach is
// four texels. The kernel is that of Castaño 2013, "Shadow Mapping Summary", here over raw depths, so that every texel
// has a reference depth of its own. CPU reference: src/receive/reference. Requires: view, texels, gather.
//
// The sum is written out and taken two rows at a time, as in `filter_tent3`.

// Returns the visibility of the light, in [0, 1].
fn shadow_filter_tent7(map: ShadowMap, map_sampler: sampler, receiver: ShadowReceiver) -> f32 {
    let kernel = shadow_kernel(receiver);
    let s = kernel.fraction.y;
    let top = shadow_tent7_rows(map, map_sampler, receiver, kernel, -3.0);
    let upper = shadow_tent7_rows(map, map_sampler, receiver, kernel, -1.0);
    let lower = shadow_tent7_rows(map, map_sampler, receiver, kernel, 1.0);
    let bottom = shadow_tent7_rows(map, map_sampler, receiver, kernel, 3.0);
    let sum = dot(top, vec2<f32>(1.0 - s, 5.0 - 4.0 * s))
        + dot(upper, vec2<f32>(12.0 - 7.0 * s, 16.0 - 4.0 * s))
        + dot(lower, vec2<f32>(12.0 + 4.0 * s, 5.0 + 7.0 * s))
        + dot(bottom, vec2<f32>(1.0 + 4.0 * s, s));
    return shadow_ramped(receiver, sum);
}

// Returns the weighted sums of the comparisons in rows `row` and `row + 1`, times fifty-two.
fn shadow_tent7_rows(
    map: ShadowMap,
    map_sampler: sampler,
    receiver: ShadowReceiver,
    kernel: ShadowKernel,
    row: f32,
) -> vec2<f32> {
    let s = kernel.fraction.x;
    let depths = shadow_texels_by_8(map, map_sampler, receiver, kernel.base + vec2<f32>(-2.0, row + 1.0));
    let rows = shadow_kernel_rows(receiver, kernel, row);
    return shadow_lit_rows(receiver, rows, -3.0, vec2<f32>(1.0 - s, 5.0 - 4.0 * s), depths[0])
        + shadow_lit_rows(receiver, rows, -1.0, vec2<f32>(12.0 - 7.0 * s, 16.0 - 4.0 * s), depths[1])
        + shadow_lit_rows(receiver, rows, 1.0, vec2<f32>(12.0 + 4.0 * s, 5.0 + 7.0 * s), depths[2])
        + shadow_lit_rows(receiver, rows, 3.0, vec2<f32>(1.0 + 4.0 * s, s), depths[3]);
}
