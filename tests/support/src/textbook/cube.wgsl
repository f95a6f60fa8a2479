// Contains what both lookups of a cube map read.

struct View {
    clip_from_world: mat4x4<f32>,
    // Has the far distance in w.
    light: vec4<f32>,
    viewer_or_sun: vec4<f32>,
}

@group(1) @binding(0) var<uniform> view: View;
@group(1) @binding(1) var map: texture_depth_cube;
@group(1) @binding(2) var map_sampler: sampler;

// Returns the distance from the light to the first surface along `direction`.
fn stored_distance(direction: vec3<f32>) -> f32 {
    return textureSampleLevel(map, map_sampler, direction, 0) * view.light.w;
}
