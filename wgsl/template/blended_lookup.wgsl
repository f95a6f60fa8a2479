
// Returns the visibility of the light, in [0, 1], from a position in render space. It is 1 where no
// cascade covers the position.
//
// It is the weighted mean of all cascades that cover the position, from near to far. Each cascade
// takes its weight from the share that the cascades before it have left, and takes less of it
// toward its border. The mean is therefore continuous across every border. Only next to a border
// are there two lookups, so they are a loop: written out, each cascade would add the instructions
// of another lookup.
fn shadow_NAME(INDEX: u32, position: vec3<f32>, normal: vec3<f32>) -> f32 {
    let first = shadow_place_of_NAME(INDEX, position);
    if !first.inside {
        return 1.0;
    }
    let weight = shadow_WEIGHT(shadow_views_NAME[0], position);
    let normal_light = shadow_axes_of_NAME(INDEX, position, normal);
    var lit = 0.0;
    var share = 0.0;
    for (var view = first.layer; view < VIEW_COUNT && share < 1.0; view++) {
        let place = shadow_directional_place(shadow_views_NAME[view], view, first.position_light);
        if place.inside {
            let part = (1.0 - share) * shadow_blend_weight(shadow_views_NAME[view], place);
            let mapping = shadow_views_NAME[view].mapping;
            var receiver = shadow_BIAS(shadow_views_NAME[0], mapping, place, normal_light);
            receiver.layer = LAYER;
            lit += part * shadow_FILTER(shadow_map_NAME, SAMPLER, receiver);
            share += part;
        }
    }
    return shadow_FADED(weight, lit / share);
}
