// Reads raw depths of a map by single samples, for devices that cannot gather. A composition that
// names this module includes it instead of `texels`. The map is then bound as an unfilterable
// `texture_2d_array<f32>`, and the sampler filters to the nearest texel and clamps.
//
// It uses samples and not loads: in OpenGL a texture that is read without a sampler uses the filter
// of its own, and a depth texture whose own filter is linear is incomplete and reads as nothing.
// The samples lie at the centres of texels. Every position that selects another texel is half a
// texel away, so rounding cannot select it. Requires: view.

// Is the type of a map for the filters that compare each texel.
alias ShadowMap = texture_2d_array<f32>;

// Returns the four texels around `corner`, in texel coordinates: upper left, upper right, lower
// left, lower right. Beyond the sides of the map they are those of the nearest texel inside.
fn shadow_texels(
    map: ShadowMap,
    map_sampler: sampler,
    receiver: ShadowReceiver,
    corner: vec2<f32>,
) -> vec4<f32> {
    let near = (corner - 0.5) * receiver.uv_per_texel;
    let far = (corner + 0.5) * receiver.uv_per_texel;
    return vec4<f32>(
        textureSampleLevel(map, map_sampler, near, receiver.layer, 0.0).x,
        textureSampleLevel(map, map_sampler, vec2<f32>(far.x, near.y), receiver.layer, 0.0).x,
        textureSampleLevel(map, map_sampler, vec2<f32>(near.x, far.y), receiver.layer, 0.0).x,
        textureSampleLevel(map, map_sampler, far, receiver.layer, 0.0).x,
    );
}
