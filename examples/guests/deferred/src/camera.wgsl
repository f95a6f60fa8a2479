// Defines the camera, and where a pixel's surface is.

struct Camera {
    clip_from_render: mat4x4<f32>,
    render_from_clip: mat4x4<f32>,
    eye: vec4<f32>,
}
@group(0) @binding(0) var<uniform> camera: Camera;

fn position_of_pixel(pixel: vec2<u32>, size: vec2<u32>, depth: f32) -> vec3<f32> {
    let middle = (vec2<f32>(pixel) + 0.5) / vec2<f32>(size);
    let ndc = vec3(middle * vec2(2.0, -2.0) + vec2(-1.0, 1.0), depth);
    let homogeneous = camera.render_from_clip * vec4(ndc, 1.0);
    return homogeneous.xyz / homogeneous.w;
}
