
// Returns the first view of the light that covers a position of render space, which is also its
// layer, or the number of all views where none does.
fn shadow_view_NAME(INDEX: u32, position: vec3<f32>) -> u32 {
    let place = shadow_place_of_NAME(INDEX, position);
    return select(VIEW_COUNT, place.layer, place.inside);
}
