
// Returns the light's view, which is also its layer, where it covers a position in render space, and otherwise the
// number of all views.
fn shadow_view_NAME(INDEX: u32, position: vec3<f32>) -> u32 {
    let view = FIRST_VIEW;
    if view < VIEW_COUNT && shadow_view_holds(shadow_views_NAME[view], position) {
        return view;
    }
    return VIEW_COUNT;
}
