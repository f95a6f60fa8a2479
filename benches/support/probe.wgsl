// Samples the light once per pixel. The text before this one defines `shadow_light`.

struct Point {
    position: vec3<f32>,
    normal: vec3<f32>,
}

@group(0) @binding(0) var<storage, read> points: array<Point>;
@group(0) @binding(1) var<storage, read_write> answers: array<f32>;

@compute @workgroup_size(64)
fn ask(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x < arrayLength(&points) {
        let point = points[id.x];
        answers[id.x] = shadow_light(point.position, point.normal);
    }
}
