// Draws the depth pass of a map with standard depth.

struct View {
    clip_from_world: mat4x4<f32>,
    light: vec4<f32>,
    viewer_or_sun: vec4<f32>,
}

@group(0) @binding(0) var<uniform> view: View;

@vertex
fn vertex(@location(0) position: vec3<f32>) -> @builtin(position) vec4<f32> {
    return view.clip_from_world * vec4<f32>(position, 1.0);
}
