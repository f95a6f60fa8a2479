// Samples as the tutorial at learnopengl.com does: one orthographic map, a bias by slope, and the mean of nine comparisons,
// written out, as compilers unroll the tutorial's loop.

struct Light {
    clip_from_world: mat4x4<f32>,
    toward_light: vec4<f32>,
}

@group(0) @binding(0) var<uniform> light: Light;
@group(0) @binding(1) var map: texture_depth_2d;
@group(0) @binding(2) var map_sampler: sampler;

fn shadowed(uv: vec2<f32>, depth: f32) -> f32 {
    return select(0.0, 1.0, depth > textureSampleLevel(map, map_sampler, uv, 0));
}

fn visibility(position: vec3<f32>, normal: vec3<f32>) -> f32 {
    let clip = light.clip_from_world * vec4<f32>(position, 1.0);
    let ndc = clip.xyz / clip.w;
    if ndc.z > 1.0 {
        return 1.0;
    }
    let uv = vec2<f32>(0.5 + 0.5 * ndc.x, 0.5 - 0.5 * ndc.y);
    let bias = max(0.05 * (1.0 - dot(normal, light.toward_light.xyz)), 0.005);
    let depth = ndc.z - bias;
    let texel = 1.0 / vec2<f32>(textureDimensions(map));
    let shadow = shadowed(uv - texel, depth)
        + shadowed(uv + vec2<f32>(0.0, -texel.y), depth)
        + shadowed(uv + vec2<f32>(texel.x, -texel.y), depth)
        + shadowed(uv + vec2<f32>(-texel.x, 0.0), depth)
        + shadowed(uv, depth)
        + shadowed(uv + vec2<f32>(texel.x, 0.0), depth)
        + shadowed(uv + vec2<f32>(-texel.x, texel.y), depth)
        + shadowed(uv + vec2<f32>(0.0, texel.y), depth)
        + shadowed(uv + texel, depth);
    return 1.0 - shadow / 9.0;
}
