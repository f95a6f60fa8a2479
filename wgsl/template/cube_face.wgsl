
// Returns where a position of render space falls on the face of the cube on which it lies as seen
// from the light.
fn shadow_place_of_NAME(INDEX: u32, position: vec3<f32>) -> ShadowPlace {
    let from_light = position - shadow_views_NAME[ANY_VIEW].anchor;
    let face = shadow_face(from_light);
    let view = FIRST_VIEW + face.index;
    let mapping = shadow_views_NAME[view].mapping;
    let grid = shadow_views_NAME[view].grid;
    let position_light = shadow_along_face(face, from_light);
    var light = shadow_views_NAME[ANY_VIEW];
    light.mapping.inner = shadow_views_NAME[INNER_VIEW].mapping.inner;
    var place = shadow_local_place(light, mapping, view, grid, position_light);
    place.inside = place.inside & (view < VIEW_COUNT);
    return place;
}

// Returns a vector of render space along the axes of the face on which a position lies.
fn shadow_axes_of_NAME(INDEX: u32, position: vec3<f32>, vector: vec3<f32>) -> vec3<f32> {
    return shadow_along_face(shadow_face(position - shadow_views_NAME[ANY_VIEW].anchor), vector);
}
