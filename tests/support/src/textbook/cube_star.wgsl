
// Averages 20 comparisons along fixed directions, with a constant bias and a radius that grows with the distance from
// the camera.
fn shadow_light(position: vec3<f32>, normal: vec3<f32>) -> f32 {
    var directions = array<vec3<f32>, 20>(
        vec3<f32>(1.0, 1.0, 1.0), vec3<f32>(1.0, -1.0, 1.0),
        vec3<f32>(-1.0, -1.0, 1.0), vec3<f32>(-1.0, 1.0, 1.0),
        vec3<f32>(1.0, 1.0, -1.0), vec3<f32>(1.0, -1.0, -1.0),
        vec3<f32>(-1.0, -1.0, -1.0), vec3<f32>(-1.0, 1.0, -1.0),
        vec3<f32>(1.0, 1.0, 0.0), vec3<f32>(1.0, -1.0, 0.0),
        vec3<f32>(-1.0, -1.0, 0.0), vec3<f32>(-1.0, 1.0, 0.0),
        vec3<f32>(1.0, 0.0, 1.0), vec3<f32>(-1.0, 0.0, 1.0),
        vec3<f32>(1.0, 0.0, -1.0), vec3<f32>(-1.0, 0.0, -1.0),
        vec3<f32>(0.0, 1.0, 1.0), vec3<f32>(0.0, -1.0, 1.0),
        vec3<f32>(0.0, -1.0, -1.0), vec3<f32>(0.0, 1.0, -1.0),
    );
    let from_light = position - view.light.xyz;
    let reference = length(from_light) - 0.15;
    let viewer = distance(view.viewer_or_sun.xyz, position);
    let radius = (1.0 + viewer / view.light.w) / 25.0;
    var shadow = 0.0;
    for (var i = 0; i < 20; i++) {
        let stored = stored_distance(from_light + directions[i] * radius);
        shadow += select(0.0, 1.0, reference > stored);
    }
    return 1.0 - shadow / 20.0;
}
