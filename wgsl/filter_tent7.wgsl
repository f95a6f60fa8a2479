// Applies the kernel [1 5 12 16 12 5 1] per axis to bilinear comparisons: 8x8 texels in sixteen
// gathers. The reach is four texels. The kernel is that of Castaño 2013, "Shadow Mapping Summary",
// here over raw depths, so that every texel has a reference depth of its own. CPU reference:
// src/receive/reference. Requires: view, texels, texel_blocks, gather.
//
// The sum is written out and taken two rows at a time, as in `filter_tent3`.

// Returns the visibility of the light, in [0, 1].
fn shadow_filter_tent7(map: ShadowMap, map_sampler: sampler, receiver: ShadowReceiver) -> f32 {
    let kernel = shadow_kernel(receiver);
    let s = kernel.fraction;
    // Are the weights of pairs of columns.
    let far_left = vec2<f32>(1.0 - s.x, 5.0 - 4.0 * s.x);
    let left = vec2<f32>(12.0 - 7.0 * s.x, 16.0 - 4.0 * s.x);
    let right = vec2<f32>(12.0 + 4.0 * s.x, 5.0 + 7.0 * s.x);
    let far_right = vec2<f32>(1.0 + 4.0 * s.x, s.x);
    let corner = kernel.base - 2.0;
    var rows = shadow_kernel_rows(receiver, kernel, -3.0);
    var block = shadow_texels(map, map_sampler, receiver, corner);
    var lit = shadow_lit_rows(receiver, rows, -3.0, far_left, block, vec2<f32>(0.0));
    block = shadow_texels_2_0(map, map_sampler, receiver, corner);
    lit = shadow_lit_rows(receiver, rows, -1.0, left, block, lit);
    block = shadow_texels_4_0(map, map_sampler, receiver, corner);
    lit = shadow_lit_rows(receiver, rows, 1.0, right, block, lit);
    block = shadow_texels_6_0(map, map_sampler, receiver, corner);
    lit = shadow_lit_rows(receiver, rows, 3.0, far_right, block, lit);
    var sum = (1.0 - s.y) * lit.x;
    sum += (5.0 - 4.0 * s.y) * lit.y;
    rows = shadow_kernel_rows(receiver, kernel, -1.0);
    block = shadow_texels_0_2(map, map_sampler, receiver, corner);
    lit = shadow_lit_rows(receiver, rows, -3.0, far_left, block, vec2<f32>(0.0));
    block = shadow_texels_2_2(map, map_sampler, receiver, corner);
    lit = shadow_lit_rows(receiver, rows, -1.0, left, block, lit);
    block = shadow_texels_4_2(map, map_sampler, receiver, corner);
    lit = shadow_lit_rows(receiver, rows, 1.0, right, block, lit);
    block = shadow_texels_6_2(map, map_sampler, receiver, corner);
    lit = shadow_lit_rows(receiver, rows, 3.0, far_right, block, lit);
    sum += (12.0 - 7.0 * s.y) * lit.x;
    sum += (16.0 - 4.0 * s.y) * lit.y;
    rows = shadow_kernel_rows(receiver, kernel, 1.0);
    block = shadow_texels_0_4(map, map_sampler, receiver, corner);
    lit = shadow_lit_rows(receiver, rows, -3.0, far_left, block, vec2<f32>(0.0));
    block = shadow_texels_2_4(map, map_sampler, receiver, corner);
    lit = shadow_lit_rows(receiver, rows, -1.0, left, block, lit);
    block = shadow_texels_4_4(map, map_sampler, receiver, corner);
    lit = shadow_lit_rows(receiver, rows, 1.0, right, block, lit);
    block = shadow_texels_6_4(map, map_sampler, receiver, corner);
    lit = shadow_lit_rows(receiver, rows, 3.0, far_right, block, lit);
    sum += (12.0 + 4.0 * s.y) * lit.x;
    sum += (5.0 + 7.0 * s.y) * lit.y;
    rows = shadow_kernel_rows(receiver, kernel, 3.0);
    block = shadow_texels_0_6(map, map_sampler, receiver, corner);
    lit = shadow_lit_rows(receiver, rows, -3.0, far_left, block, vec2<f32>(0.0));
    block = shadow_texels_2_6(map, map_sampler, receiver, corner);
    lit = shadow_lit_rows(receiver, rows, -1.0, left, block, lit);
    block = shadow_texels_4_6(map, map_sampler, receiver, corner);
    lit = shadow_lit_rows(receiver, rows, 1.0, right, block, lit);
    block = shadow_texels_6_6(map, map_sampler, receiver, corner);
    lit = shadow_lit_rows(receiver, rows, 3.0, far_right, block, lit);
    sum += (1.0 + 4.0 * s.y) * lit.x;
    sum += s.y * lit.y;
    return shadow_ramped(receiver, sum);
}
