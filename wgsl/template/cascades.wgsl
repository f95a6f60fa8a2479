
// Returns where a position of render space falls in the first cascade that covers it. The cascades
// are written out, since compilers unroll no loop that WGSL bounds at run time.
fn shadow_place_of_NAME(INDEX: u32, position: vec3<f32>) -> ShadowPlace {
    let relative = position - shadow_views_NAME[0].anchor;
    return shadow_cascade_CASCADE_of_NAME(shadow_axes_of_NAME(INDEX, position, relative));
}

// Returns a vector of render space along the axes of light space, which are the same for all
// cascades.
fn shadow_axes_of_NAME(INDEX: u32, position: vec3<f32>, vector: vec3<f32>) -> vec3<f32> {
    return shadow_light_from_render(shadow_views_NAME[0], vector);
}
