
// Returns where a position of render space falls in the light's view.
fn shadow_place_of_NAME(INDEX: u32, position: vec3<f32>) -> ShadowPlace {
    let view = FIRST_VIEW;
    let relative = position - shadow_views_NAME[ANY_VIEW].anchor;
    let position_light = shadow_axes_of_NAME(INDEX, position, relative);
    let mapping = shadow_views_NAME[ANY_VIEW].mapping;
    let grid = shadow_views_NAME[ANY_VIEW].grid;
    let light = shadow_views_NAME[ANY_VIEW];
    var place = shadow_local_place(light, mapping, view, grid, position_light);
    place.inside = place.inside & shadow_in_cone(light, place) & (view < VIEW_COUNT);
    return place;
}

// Returns a vector of render space along the axes of light space.
fn shadow_axes_of_NAME(INDEX: u32, position: vec3<f32>, vector: vec3<f32>) -> vec3<f32> {
    return shadow_light_from_render(shadow_views_NAME[ANY_VIEW], vector);
}
