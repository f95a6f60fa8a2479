// Takes one of the samples of the tutorial at learnopengl.com for point lights: the distance from the light in a cube map.

struct Light {
    // Has the far distance in w.
    position: vec4<f32>,
    // Is one of the tutorial's offsets of the direction.
    offset: vec4<f32>,
}

@group(0) @binding(0) var<uniform> light: Light;
@group(0) @binding(1) var map: texture_depth_cube;
@group(0) @binding(2) var map_sampler: sampler;

fn visibility(position: vec3<f32>, normal: vec3<f32>) -> f32 {
    let from_light = position - light.position.xyz;
    let reference = length(from_light) - 0.05;
    let stored = textureSampleLevel(map, map_sampler, from_light + light.offset.xyz, 0);
    return select(1.0, 0.0, reference > stored * light.position.w);
}
