// Four raw depths of a map by four samples, for devices that cannot gather. Takes the place of `texels` where it is named; the
// map is then bound as `texture_2d_array<f32>`, unfilterable, and the sampler is nearest and clamps.
//
// Samples and not loads: in OpenGL a texture is read through the filter of its own where no sampler goes with it, and a depth
// texture whose own filter is linear holds nothing.
// Requires: view.

alias ShadowMap = texture_2d_array<f32>;

fn shadow_texels(
    map: ShadowMap,
    map_sampler: sampler,
    receiver: ShadowReceiver,
    first: vec2<f32>,
) -> vec4<f32> {
    // Middles of texels: half a texel from every other choice, so rounding cannot miss them.
    let near = (first + 0.5) / receiver.map_size;
    let far = (first + 1.5) / receiver.map_size;
    return vec4<f32>(
        textureSampleLevel(map, map_sampler, near, receiver.layer, 0.0).x,
        textureSampleLevel(map, map_sampler, vec2<f32>(far.x, near.y), receiver.layer, 0.0).x,
        textureSampleLevel(map, map_sampler, vec2<f32>(near.x, far.y), receiver.layer, 0.0).x,
        textureSampleLevel(map, map_sampler, far, receiver.layer, 0.0).x,
    );
}
