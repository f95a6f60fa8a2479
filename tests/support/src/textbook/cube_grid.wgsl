
// Averages 64 comparisons on a grid of offsets from -0.1 to 0.05, with a constant bias.
fn shadow_light(position: vec3<f32>, normal: vec3<f32>) -> f32 {
    let from_light = position - view.light.xyz;
    let reference = length(from_light) - 0.05;
    let offset = 0.1;
    let step = offset / (4.0 * 0.5);
    var shadow = 0.0;
    for (var x = -offset; x < offset; x += step) {
        for (var y = -offset; y < offset; y += step) {
            for (var z = -offset; z < offset; z += step) {
                let stored = stored_distance(from_light + vec3<f32>(x, y, z));
                shadow += select(0.0, 1.0, reference > stored);
            }
        }
    }
    return 1.0 - shadow / 64.0;
}
