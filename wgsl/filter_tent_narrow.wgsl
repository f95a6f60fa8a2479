// Bilinear comparisons under the kernel [1 2 1] per axis: 4x4 texels in four gathers. Reach: two texels.
// Kernel: Castaño 2013, "Shadow Mapping Summary", here over raw depths so that every texel has its own reference.
// Rust twin: src/receive/reference.rs. Requires: view, gather.

fn shadow_filter_tent_narrow(
    map: texture_depth_2d_array,
    map_sampler: sampler,
    receiver: ShadowReceiver,
) -> f32 {
    let from_centers = receiver.texel - 0.5;
    let base = floor(from_centers);
    let s = from_centers - base;
    let first = base - 1.0;
    // Weights of pairs of texels along each axis, times four.
    var across = array<vec2<f32>, 2>(vec2<f32>(1.0 - s.x, 2.0 - s.x), vec2<f32>(1.0 + s.x, s.x));
    var down = array<vec2<f32>, 2>(vec2<f32>(1.0 - s.y, 2.0 - s.y), vec2<f32>(1.0 + s.y, s.y));
    var lit = 0.0;
    for (var y = 0u; y < 2u; y++) {
        for (var x = 0u; x < 2u; x++) {
            let block = shadow_gather(map, map_sampler, receiver, first + 2.0 * vec2<f32>(vec2<u32>(x, y)));
            lit += dot(block, vec4<f32>(across[x] * down[y].x, across[x] * down[y].y));
        }
    }
    return shadow_sharpen(lit / 16.0, receiver.sharpness);
}
