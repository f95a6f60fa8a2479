// Applies the 3x3 percentage-closer filter of the tutorial at learnopengl.com: the mean of nearest
// comparisons, one texel apart, with nine texels, in steps of a ninth, from four gathers. The reach
// is one and a half texels. CPU reference: src/receive/reference. Requires: view, texels,
// texel_blocks, gather.

// Returns the visibility of the light, in [0, 1].
fn shadow_filter_box(map: ShadowMap, map_sampler: sampler, receiver: ShadowReceiver) -> f32 {
    let base = floor(receiver.texel);
    let from_center = receiver.texel - 0.5 - base;
    let depth = receiver.depth - dot(receiver.gradient, from_center);
    let kernel = ShadowKernel(base, from_center, depth);
    let upper = shadow_box_rows(map, map_sampler, receiver, kernel, -1.0);
    let lower = shadow_box_rows(map, map_sampler, receiver, kernel, 1.0);
    return shadow_ramped(receiver, upper.x + upper.y + lower.x);
}

// Returns the numbers of lit texels in two rows of three.
fn shadow_box_rows(
    map: ShadowMap,
    map_sampler: sampler,
    receiver: ShadowReceiver,
    kernel: ShadowKernel,
    row: f32,
) -> vec2<f32> {
    let corner = kernel.base + vec2<f32>(0.0, row + 1.0);
    let rows = shadow_kernel_rows(receiver, kernel, row);
    let left = shadow_texels(map, map_sampler, receiver, corner);
    let sum = shadow_lit_rows(receiver, rows, -1.0, vec2<f32>(1.0, 1.0), left, vec2<f32>(0.0));
    let right = shadow_texels_2_0(map, map_sampler, receiver, corner);
    return shadow_lit_rows(receiver, rows, 1.0, vec2<f32>(1.0, 0.0), right, sum);
}
