
// Returns the first cascade that covers a position in render space, which is also its layer, or the number of cascades
// where none does. A directional light has neither a range nor a cone to be checked.
fn shadow_view_NAME(INDEX: u32, position: vec3<f32>) -> u32 {
    for (var view = 0u; view < VIEW_COUNT; view++) {
        if shadow_view_covers(shadow_views_NAME[view], position) {
            return view;
        }
    }
    return VIEW_COUNT;
}
