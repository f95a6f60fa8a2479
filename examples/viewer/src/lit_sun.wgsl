
fn lit(surface: Surface, normal: vec3<f32>) -> vec3<f32> {
    return shade(surface, shadow_sun(surface.position, normal));
}
