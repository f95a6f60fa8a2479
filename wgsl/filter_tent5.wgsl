// Applies the kernel [1 3 4 3 1] per axis to bilinear comparisons: 6x6 texels in nine gathers. The
// reach is three texels. The kernel is that of Castaño 2013, "Shadow Mapping Summary", here over
// raw depths, so that every texel has a reference depth of its own. CPU reference:
// src/receive/reference. Requires: view, texels, texel_blocks, gather.
//
// The sum is written out and taken two rows at a time, as in `filter_tent3`.

// Returns the visibility of the light, in [0, 1].
fn shadow_filter_tent5(map: ShadowMap, map_sampler: sampler, receiver: ShadowReceiver) -> f32 {
    let kernel = shadow_kernel(receiver);
    let s = kernel.fraction;
    // Are the weights of pairs of columns.
    let left = vec2<f32>(1.0 - s.x, 3.0 - 2.0 * s.x);
    let middle = vec2<f32>(4.0 - s.x, 3.0 + s.x);
    let right = vec2<f32>(1.0 + 2.0 * s.x, s.x);
    let corner = kernel.base - 1.0;
    var rows = shadow_kernel_rows(receiver, kernel, -2.0);
    var block = shadow_texels(map, map_sampler, receiver, corner);
    var lit = shadow_lit_rows(receiver, rows, -2.0, left, block, vec2<f32>(0.0));
    block = shadow_texels_2_0(map, map_sampler, receiver, corner);
    lit = shadow_lit_rows(receiver, rows, 0.0, middle, block, lit);
    block = shadow_texels_4_0(map, map_sampler, receiver, corner);
    lit = shadow_lit_rows(receiver, rows, 2.0, right, block, lit);
    var sum = (1.0 - s.y) * lit.x;
    sum += (3.0 - 2.0 * s.y) * lit.y;
    rows = shadow_kernel_rows(receiver, kernel, 0.0);
    block = shadow_texels_0_2(map, map_sampler, receiver, corner);
    lit = shadow_lit_rows(receiver, rows, -2.0, left, block, vec2<f32>(0.0));
    block = shadow_texels_2_2(map, map_sampler, receiver, corner);
    lit = shadow_lit_rows(receiver, rows, 0.0, middle, block, lit);
    block = shadow_texels_4_2(map, map_sampler, receiver, corner);
    lit = shadow_lit_rows(receiver, rows, 2.0, right, block, lit);
    sum += (4.0 - s.y) * lit.x;
    sum += (3.0 + s.y) * lit.y;
    rows = shadow_kernel_rows(receiver, kernel, 2.0);
    block = shadow_texels_0_4(map, map_sampler, receiver, corner);
    lit = shadow_lit_rows(receiver, rows, -2.0, left, block, vec2<f32>(0.0));
    block = shadow_texels_2_4(map, map_sampler, receiver, corner);
    lit = shadow_lit_rows(receiver, rows, 0.0, middle, block, lit);
    block = shadow_texels_4_4(map, map_sampler, receiver, corner);
    lit = shadow_lit_rows(receiver, rows, 2.0, right, block, lit);
    sum += (1.0 + 2.0 * s.y) * lit.x;
    sum += s.y * lit.y;
    return shadow_ramped(receiver, sum);
}
