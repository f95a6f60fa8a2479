
// Returns the visibility of the light, in [0, 1], from a position in render space. It is 1 beyond
// the light's range.
//
// It is the mean of samples in directions around that of the position. Each sample is looked up on
// the face of the cube that its direction meets.
fn shadow_NAME(INDEX: u32, position: vec3<f32>, normal: vec3<f32>) -> f32 {
    let anchor = shadow_views_NAME[ANY_VIEW].anchor;
    let from_light = position - anchor;
    // The distance, which varies, is the left side of the comparison and the uniform the right
    // side, because of the driver defect that `place` describes.
    if length(from_light) >= shadow_views_NAME[ANY_VIEW].range {
        return 1.0;
    }
    let weight = shadow_WEIGHT(shadow_views_NAME[ANY_VIEW], position);
    let radius = shadow_direction_PATTERN_radius(shadow_views_NAME[ANY_VIEW], position);
    var lit = 0.0;
    for (var i = 0u; i < SAMPLE_COUNT; i++) {
        let offset = shadow_direction_PATTERN(i) * radius;
        let sampled = shadow_direction_on_SURFACE(from_light, NORMAL, offset) + anchor;
        let place = shadow_place_of_NAME(INDEX, sampled);
        if place.inside {
            let normal_light = shadow_axes_of_NAME(INDEX, sampled, normal);
            let mapping = shadow_views_NAME[place.layer].mapping;
            var receiver = shadow_BIAS(shadow_views_NAME[ANY_VIEW], mapping, place, normal_light);
            receiver.layer = LAYER;
            lit += shadow_FILTER(shadow_map_NAME, SAMPLER, receiver);
        } else {
            lit += 1.0;
        }
    }
    return shadow_FADED(weight, lit / SAMPLE_COUNT_F32);
}
