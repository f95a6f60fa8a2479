// Compares 2x2 gathered texels and weights the results bilinearly in full precision. The reach is
// one texel. CPU reference: src/receive/reference. Requires: view, texels, gather.

// Returns the visibility of the light, in [0, 1].
fn shadow_filter_bilinear(map: ShadowMap, map_sampler: sampler, receiver: ShadowReceiver) -> f32 {
    let kernel = shadow_kernel(receiver);
    let s = kernel.fraction;
    let depths = shadow_texels(map, map_sampler, receiver, kernel.base + 1.0);
    let rows = shadow_kernel_rows(receiver, kernel, 0.0);
    let columns = vec2<f32>(1.0 - s.x, s.x);
    let lit = shadow_lit_rows(receiver, rows, 0.0, columns, depths, vec2<f32>(0.0));
    return shadow_ramped(receiver, mix(lit.x, lit.y, s.y));
}
