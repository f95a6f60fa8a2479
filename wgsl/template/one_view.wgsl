
// Returns the light's view, which is also its layer, if it holds a position of render space, or the number of all views if not.
fn shadow_view_NAME(INDEX: u32, position: vec3<f32>) -> u32 {
    let view = FIRST_VIEW;
    if view < VIEW_COUNT && shadow_view_holds(shadow_views_NAME[view], position) {
        return view;
    }
    return VIEW_COUNT;
}
