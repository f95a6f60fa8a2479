// The two pictures of a step. `shadow_sun` is what is put in front of this text, and Blinn-Phong what is between.

@fragment
fn fragment_picture(surface: Surface) -> @location(0) vec4<f32> {
    let visibility = shadow_sun(surface.position, surface.normal);
    return vec4<f32>(shade(surface, visibility), 1.0);
}

// The visibility alone, for measuring.
@fragment
fn fragment_visibility(surface: Surface) -> @location(0) vec4<f32> {
    return vec4<f32>(shadow_sun(surface.position, surface.normal), 0.0, 0.0, 1.0);
}
