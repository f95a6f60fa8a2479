
// Returns the visibility of the light, in [0, 1], from a position in render space. It is 1 where no cascade covers the
// position.
//
// It is the weighted mean of all cascades that cover the position, from near to far. Each cascade takes its weight from
// the share that the cascades before it have left, and takes less of it toward its border. The mean is therefore
// continuous across every border.
fn shadow_NAME(INDEX: u32, position: vec3<f32>, normal: vec3<f32>) -> f32 {
    var lit = 0.0;
    var share = 0.0;
    for (var view = shadow_view_NAME(INDEX, position); view < VIEW_COUNT && share < 1.0; view++) {
        if shadow_view_covers(shadow_views_NAME[view], position) {
            let weight = (1.0 - share) * shadow_view_weight(shadow_views_NAME[view], position);
            let receiver = shadow_receiver_BIAS(shadow_views_NAME[view], position, normal);
            lit += weight * shadow_FILTER(shadow_map_NAME, SAMPLER, receiver);
            share += weight;
        }
    }
    let visibility = select(1.0, lit / share, share > 0.0);
    return shadow_LIMIT(shadow_views_NAME[0], position, visibility);
}
