
// Returns where a position of light space falls in the first cascade from this one on that covers
// it. What it returns where none does is not inside.
fn shadow_cascade_CASCADE_of_NAME(position_light: vec3<f32>) -> ShadowPlace {
    let place = shadow_directional_place(shadow_views_NAME[CASCADE], CASCADE, position_light);
    return shadow_first_place(place, shadow_cascade_NEXT_of_NAME(position_light));
}
