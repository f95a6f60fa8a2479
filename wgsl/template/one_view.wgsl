
// Returns where a position of render space falls in the light's view.
fn shadow_place_of_NAME(INDEX: u32, position: vec3<f32>) -> ShadowPlace {
    let view = FIRST_VIEW;
    let light = shadow_axes_of_NAME(INDEX, position, position - shadow_views_NAME[ANY_VIEW].anchor);
    let mapping = shadow_views_NAME[ANY_VIEW].mapping;
    let grid = shadow_views_NAME[ANY_VIEW].grid;
    var place = shadow_local_place(shadow_views_NAME[ANY_VIEW], mapping, view, grid, light);
    place.inside = place.inside & shadow_in_cone(shadow_views_NAME[ANY_VIEW], place) & (view < VIEW_COUNT);
    return place;
}

// Returns a vector of render space along the axes of light space.
fn shadow_axes_of_NAME(INDEX: u32, position: vec3<f32>, vector: vec3<f32>) -> vec3<f32> {
    return shadow_light_from_render(shadow_views_NAME[ANY_VIEW], vector);
}
