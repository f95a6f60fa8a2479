// Draws the depth pass of a cube map, which stores the fragment's distance from the light instead of its depth.

struct View {
    clip_from_world: mat4x4<f32>,
    // Has the far distance in w.
    light: vec4<f32>,
    viewer_or_sun: vec4<f32>,
}

@group(0) @binding(0) var<uniform> view: View;

struct Fragment {
    @builtin(position) clip: vec4<f32>,
    @location(0) position: vec3<f32>,
}

@vertex
fn vertex(@location(0) position: vec3<f32>) -> Fragment {
    return Fragment(view.clip_from_world * vec4<f32>(position, 1.0), position);
}

@fragment
fn fragment(in: Fragment) -> @builtin(frag_depth) f32 {
    return distance(in.position, view.light.xyz) / view.light.w;
}
