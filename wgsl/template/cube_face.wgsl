
// Returns the face on which a position of render space lies as seen from the light, which is also its layer, if that face holds
// it, or the number of all views if not.
fn shadow_view_NAME(INDEX: u32, position: vec3<f32>) -> u32 {
    let view = FIRST_VIEW + shadow_cube_face(position - shadow_views_NAME[ANY_VIEW].anchor);
    if view < VIEW_COUNT && shadow_view_holds(shadow_views_NAME[view], position) {
        return view;
    }
    return VIEW_COUNT;
}
