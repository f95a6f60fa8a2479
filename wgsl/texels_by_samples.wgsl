// Reads four raw depths of a map by four samples, for devices that cannot gather. A composition that names this module
// includes it instead of `texels`. The map is then bound as an unfilterable `texture_2d_array<f32>`, and the sampler
// filters to the nearest texel and clamps.
//
// It uses samples and not loads: in OpenGL a texture that is read without a sampler uses the filter of its own, and a
// depth texture whose own filter is linear is incomplete and reads as nothing.
// Requires: view.

// Is the type of a map for the filters that compare each texel.
alias ShadowMap = texture_2d_array<f32>;

// Returns the depths of the texels (first), (first + x), (first + y), (first + x + y). Beyond the sides of the map they
// are those of the nearest texel inside.
fn shadow_texels(
    map: ShadowMap,
    map_sampler: sampler,
    receiver: ShadowReceiver,
    first: vec2<f32>,
) -> vec4<f32> {
    // The samples lie at the centres of texels. Every position that selects another texel is half a texel away, so
    // rounding cannot select it.
    let near = (first + 0.5) / receiver.map_size;
    let far = (first + 1.5) / receiver.map_size;
    return vec4<f32>(
        textureSampleLevel(map, map_sampler, near, receiver.layer, 0.0).x,
        textureSampleLevel(map, map_sampler, vec2<f32>(far.x, near.y), receiver.layer, 0.0).x,
        textureSampleLevel(map, map_sampler, vec2<f32>(near.x, far.y), receiver.layer, 0.0).x,
        textureSampleLevel(map, map_sampler, far, receiver.layer, 0.0).x,
    );
}
