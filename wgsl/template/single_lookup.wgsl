
// Returns the visibility of the light, in [0, 1], from a position in render space. It is 1 where no
// view covers the position.
fn shadow_NAME(INDEX: u32, position: vec3<f32>, normal: vec3<f32>) -> f32 {
    let place = shadow_place_of_NAME(INDEX, position);
    if !place.inside {
        return 1.0;
    }
    let weight = shadow_WEIGHT(shadow_views_NAME[ANY_VIEW], position);
    let normal_light = shadow_axes_of_NAME(INDEX, position, normal);
    let mapping = shadow_views_NAME[place.layer].mapping;
    var receiver = shadow_BIAS(shadow_views_NAME[ANY_VIEW], mapping, place, normal_light);
    receiver.layer = LAYER;
    let visibility = shadow_FILTER(shadow_map_NAME, SAMPLER, receiver);
    return shadow_FADED(weight, visibility);
}
