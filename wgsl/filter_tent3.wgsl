// Applies the kernel [1 2 1] per axis to bilinear comparisons: 4x4 texels in four gathers. The reach is two texels. The
// kernel is that of Castaño 2013, "Shadow Mapping Summary", here over raw depths, so that every texel has a reference
// depth of its own. CPU reference: src/receive/reference. Requires: view, texels, gather.
//
// The sum is written out, since naga limits the iterations of a loop, and compilers do not unroll such a loop. It is
// taken two rows at a time, so that few depths are held at once: with more than 32 registers, fewer waves run.

// Returns the visibility of the light, in [0, 1].
fn shadow_filter_tent3(map: ShadowMap, map_sampler: sampler, receiver: ShadowReceiver) -> f32 {
    let kernel = shadow_kernel(receiver);
    let s = kernel.fraction.y;
    let upper = shadow_tent3_rows(map, map_sampler, receiver, kernel, -1.0);
    let lower = shadow_tent3_rows(map, map_sampler, receiver, kernel, 1.0);
    let sum = dot(upper, vec2<f32>(1.0 - s, 2.0 - s)) + dot(lower, vec2<f32>(1.0 + s, s));
    return shadow_ramped(receiver, sum);
}

// Returns the weighted sums of the comparisons in rows `row` and `row + 1`, times four.
fn shadow_tent3_rows(
    map: ShadowMap,
    map_sampler: sampler,
    receiver: ShadowReceiver,
    kernel: ShadowKernel,
    row: f32,
) -> vec2<f32> {
    let s = kernel.fraction.x;
    let depths = shadow_texels_by_4(map, map_sampler, receiver, kernel.base + vec2<f32>(0.0, row + 1.0));
    let rows = shadow_kernel_rows(receiver, kernel, row);
    return shadow_lit_rows(receiver, rows, -1.0, vec2<f32>(1.0 - s, 2.0 - s), depths[0])
        + shadow_lit_rows(receiver, rows, 1.0, vec2<f32>(1.0 + s, s), depths[1]);
}
