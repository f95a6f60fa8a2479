// Bilinear comparisons under the kernel [1 5 12 16 12 5 1] per axis: 8x8 texels in sixteen gathers. Reach: four texels.
// Kernel: Castaño 2013, "Shadow Mapping Summary", here over raw depths so that every texel has its own reference.
// Rust twin: src/receive/reference.rs. Requires: view, gather.

fn shadow_filter_tent_wide(
    map: texture_depth_2d_array,
    map_sampler: sampler,
    receiver: ShadowReceiver,
) -> f32 {
    let from_centers = receiver.texel - 0.5;
    let base = floor(from_centers);
    let s = from_centers - base;
    let first = base - 3.0;
    // Weights of pairs of texels along each axis, times fifty-two.
    var across = array<vec2<f32>, 4>(
        vec2<f32>(1.0 - s.x, 5.0 - 4.0 * s.x),
        vec2<f32>(12.0 - 7.0 * s.x, 16.0 - 4.0 * s.x),
        vec2<f32>(12.0 + 4.0 * s.x, 5.0 + 7.0 * s.x),
        vec2<f32>(1.0 + 4.0 * s.x, s.x),
    );
    var down = array<vec2<f32>, 4>(
        vec2<f32>(1.0 - s.y, 5.0 - 4.0 * s.y),
        vec2<f32>(12.0 - 7.0 * s.y, 16.0 - 4.0 * s.y),
        vec2<f32>(12.0 + 4.0 * s.y, 5.0 + 7.0 * s.y),
        vec2<f32>(1.0 + 4.0 * s.y, s.y),
    );
    var lit = 0.0;
    for (var y = 0u; y < 4u; y++) {
        for (var x = 0u; x < 4u; x++) {
            let block = shadow_gather(map, map_sampler, receiver, first + 2.0 * vec2<f32>(vec2<u32>(x, y)));
            lit += dot(block, vec4<f32>(across[x] * down[y].x, across[x] * down[y].y));
        }
    }
    return shadow_sharpen(lit / 2704.0, receiver.sharpness);
}
