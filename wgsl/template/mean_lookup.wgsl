
// Returns the visibility of the light, in [0, 1], from a position in render space. It is 1 beyond the light's range.
//
// It is the mean of samples in directions around that of the position. Each sample is looked up on the face of the cube
// that its direction meets.
fn shadow_NAME(INDEX: u32, position: vec3<f32>, normal: vec3<f32>) -> f32 {
    let light = shadow_views_NAME[ANY_VIEW];
    let from_light = position - light.anchor;
    // The distance, which varies, is the left side of the comparison and the uniform the right side, because of the
    // driver defect that `shadow_view_holds` describes.
    if length(from_light) >= light.range {
        return 1.0;
    }
    let radius = shadow_direction_PATTERN_radius(light, position);
    var lit = 0.0;
    for (var i = 0u; i < SAMPLE_COUNT; i++) {
        let offset = shadow_direction_PATTERN(i) * radius;
        let sampled = shadow_direction_on_SURFACE(from_light, NORMAL, offset) + light.anchor;
        let view = shadow_view_NAME(INDEX, sampled);
        if view == VIEW_COUNT {
            lit += 1.0;
        } else {
            let receiver = shadow_receiver_BIAS(shadow_views_NAME[view], sampled, normal);
            lit += shadow_FILTER(shadow_map_NAME, SAMPLER, receiver);
        }
    }
    return shadow_LIMIT(shadow_views_NAME[ANY_VIEW], position, lit / SAMPLE_COUNT_F32);
}
