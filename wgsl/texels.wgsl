// Reads four raw depths of a map at once, by a gather.
//
// Where shaders cannot gather (GLSL ES 3.0: OpenGL ES 3.0 and WebGL 2), `texels_by_samples` replaces this module.
// Requires: view.

// Is the type of a map for the filters that compare each texel.
alias ShadowMap = texture_depth_2d_array;

// Returns the depths of the texels (first), (first + x), (first + y), (first + x + y). Beyond the sides of the map they
// are those of the nearest texel inside.
fn shadow_texels(
    map: ShadowMap,
    map_sampler: sampler,
    receiver: ShadowReceiver,
    first: vec2<f32>,
) -> vec4<f32> {
    // The sample lies at the corner where the four texels meet. Every position that selects other texels is half a
    // texel away, so rounding cannot select them.
    let corner = (first + 1.0) / receiver.map_size;
    // A gather returns the texels counter-clockwise from the lower left.
    return textureGather(map, map_sampler, corner, receiver.layer).wzxy;
}
