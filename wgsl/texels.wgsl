// Four raw depths of a map at once, by a gather.
//
// Where a device has none (GLSL ES 3.0: OpenGL ES 3.0 and WebGL 2), `texels_by_samples` takes the place of this module.
// Requires: view.

// A map as the filters that compare each texel take it.
alias ShadowMap = texture_depth_2d_array;

// Depths of the texels (first), (first + x), (first + y), (first + x + y); beyond the sides, of the nearest texel inside.
fn shadow_texels(
    map: ShadowMap,
    map_sampler: sampler,
    receiver: ShadowReceiver,
    first: vec2<f32>,
) -> vec4<f32> {
    // The corner where the four texels meet: half a texel from every other choice, so rounding cannot miss them.
    let corner = (first + 1.0) / receiver.map_size;
    // Gather's order is counter-clockwise from the lower left.
    return textureGather(map, map_sampler, corner, receiver.layer).wzxy;
}
