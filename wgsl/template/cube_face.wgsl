
// Returns the face that a position in render space lies on as seen from the light, which is also its layer. Where that
// face does not cover the position, it returns the number of all views.
fn shadow_view_NAME(INDEX: u32, position: vec3<f32>) -> u32 {
    let view = FIRST_VIEW + shadow_cube_face(position - shadow_views_NAME[ANY_VIEW].anchor);
    if view < VIEW_COUNT && shadow_view_holds(shadow_views_NAME[view], position) {
        return view;
    }
    return VIEW_COUNT;
}
