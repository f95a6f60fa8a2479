// Reads raw depths of a map by gathers, four texels at once.
//
// Where shaders cannot gather (GLSL ES 3.0: OpenGL ES 3.0 and WebGL 2), `texels_by_samples`
// replaces this module. Requires: view.
//
// A gather samples at the corner where four texels meet. Every position that selects other texels
// is half a texel away, so rounding cannot select them. It returns the texels counter-clockwise
// from the lower left; here they are in the order of rows: upper left, upper right, lower left,
// lower right. Beyond the sides of the map they are those of the nearest texel inside.

// Is the type of a map for the filters that compare each texel.
alias ShadowMap = texture_depth_2d_array;

// Returns the four texels around `corner`, in texel coordinates.
fn shadow_texels(
    map: ShadowMap,
    map_sampler: sampler,
    receiver: ShadowReceiver,
    corner: vec2<f32>,
) -> vec4<f32> {
    return textureGather(map, map_sampler, corner * receiver.uv_per_texel, receiver.layer).wzxy;
}
