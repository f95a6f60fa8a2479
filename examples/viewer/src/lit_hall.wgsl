
// `lit_hall` is that of the text before this one.
fn lit(surface: Surface, normal: vec3<f32>) -> vec3<f32> {
    return lit_hall(surface);
}
