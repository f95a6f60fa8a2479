// Draws the two images of a step. The text before this one defines Blinn-Phong, and the one before
// that `shadow_sun`.

@fragment
fn fragment_picture(surface: Surface) -> @location(0) vec4<f32> {
    let visibility = shadow_sun(surface.position, surface.normal);
    return vec4<f32>(shade(surface, visibility), 1.0);
}

// Writes the visibility alone, for measuring.
@fragment
fn fragment_visibility(surface: Surface) -> @location(0) vec4<f32> {
    return vec4<f32>(shadow_sun(surface.position, surface.normal), 0.0, 0.0, 1.0);
}
