
// Returns where a position of light space falls in the last cascade.
fn shadow_cascade_NEXT_of_NAME(position_light: vec3<f32>) -> ShadowPlace {
    return shadow_directional_place(shadow_views_NAME[NEXT], NEXT, position_light);
}
