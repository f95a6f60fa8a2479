// The room's fragment stage. `shadow_lamp` is what is put in front of this text, and Blinn-Phong what is between.

@fragment
fn fragment(surface: Surface) -> @location(0) vec4<f32> {
    let visibility = shadow_lamp(surface.position, surface.normal);
    return vec4<f32>(shade(surface, visibility), 1.0);
}
