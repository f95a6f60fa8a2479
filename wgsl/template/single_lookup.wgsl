
// Returns the visibility of the light, in [0, 1], from a position in render space. It is 1 where no view covers the
// position.
fn shadow_NAME(INDEX: u32, position: vec3<f32>, normal: vec3<f32>) -> f32 {
    let view = shadow_view_NAME(INDEX, position);
    if view == VIEW_COUNT {
        return 1.0;
    }
    let receiver = shadow_receiver_BIAS(shadow_views_NAME[view], position, normal);
    let visibility = shadow_FILTER(shadow_map_NAME, SAMPLER, receiver);
    return shadow_LIMIT(shadow_views_NAME[view], position, visibility);
}
