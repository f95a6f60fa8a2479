// Applies the kernel [1 2 1] per axis to bilinear comparisons: 4x4 texels in four gathers. The
// reach is two texels. The kernel is that of Castaño 2013, "Shadow Mapping Summary", here over raw
// depths, so that every texel has a reference depth of its own. CPU reference:
// src/receive/reference. Requires: view, texels, texel_blocks, gather.
//
// The sum is written out, since naga limits the iterations of a loop, and compilers do not unroll
// such a loop. It is taken two rows at a time, so that few depths are held at once: with more than
// 32 registers, fewer waves run.

// Returns the visibility of the light, in [0, 1].
fn shadow_filter_tent3(map: ShadowMap, map_sampler: sampler, receiver: ShadowReceiver) -> f32 {
    let kernel = shadow_kernel(receiver);
    let s = kernel.fraction;
    // Are the weights of pairs of columns.
    let left = vec2<f32>(1.0 - s.x, 2.0 - s.x);
    let right = vec2<f32>(1.0 + s.x, s.x);
    let corner = kernel.base;
    var rows = shadow_kernel_rows(receiver, kernel, -1.0);
    var block = shadow_texels(map, map_sampler, receiver, corner);
    var lit = shadow_lit_rows(receiver, rows, -1.0, left, block, vec2<f32>(0.0));
    block = shadow_texels_2_0(map, map_sampler, receiver, corner);
    lit = shadow_lit_rows(receiver, rows, 1.0, right, block, lit);
    var sum = (1.0 - s.y) * lit.x;
    sum += (2.0 - s.y) * lit.y;
    rows = shadow_kernel_rows(receiver, kernel, 1.0);
    block = shadow_texels_0_2(map, map_sampler, receiver, corner);
    lit = shadow_lit_rows(receiver, rows, -1.0, left, block, vec2<f32>(0.0));
    block = shadow_texels_2_2(map, map_sampler, receiver, corner);
    lit = shadow_lit_rows(receiver, rows, 1.0, right, block, lit);
    sum += (1.0 + s.y) * lit.x;
    sum += s.y * lit.y;
    return shadow_ramped(receiver, sum);
}
