// Samples as the tutorial does: bias by slope in units of the map's depth, the mean of nine comparisons, lit beyond the
// border.

struct View {
    clip_from_world: mat4x4<f32>,
    light: vec4<f32>,
    viewer_or_sun: vec4<f32>,
}

@group(1) @binding(0) var<uniform> view: View;
@group(1) @binding(1) var map: texture_depth_2d;
@group(1) @binding(2) var map_sampler: sampler;

fn shadow_light(position: vec3<f32>, normal: vec3<f32>) -> f32 {
    let clip = view.clip_from_world * vec4<f32>(position, 1.0);
    let ndc = clip.xyz / clip.w;
    if ndc.z > 1.0 {
        return 1.0;
    }
    let uv = vec2<f32>(0.5 + 0.5 * ndc.x, 0.5 - 0.5 * ndc.y);
    let toward_light = select(
        view.viewer_or_sun.xyz,
        normalize(view.light.xyz - position),
        view.light.w > 0.0,
    );
    let bias = max(0.05 * (1.0 - dot(normal, toward_light)), 0.005);
    let texel = 1.0 / vec2<f32>(textureDimensions(map));
    var shadow = 0.0;
    for (var x = -1; x <= 1; x++) {
        for (var y = -1; y <= 1; y++) {
            let place = uv + vec2<f32>(f32(x), f32(y)) * texel;
            // The border's colour is the far plane.
            let within = all(place >= vec2<f32>(0.0)) && all(place <= vec2<f32>(1.0));
            let stored = select(1.0, textureSampleLevel(map, map_sampler, place, 0), within);
            shadow += select(0.0, 1.0, ndc.z - bias > stored);
        }
    }
    return 1.0 - shadow / 9.0;
}
