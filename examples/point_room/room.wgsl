// Contains the room's fragment stage. The text before this one defines Blinn-Phong, and the one
// before that `shadow_lamp`.

@fragment
fn fragment(surface: Surface) -> @location(0) vec4<f32> {
    let visibility = shadow_lamp(surface.position, surface.normal);
    return vec4<f32>(shade(surface, visibility), 1.0);
}
