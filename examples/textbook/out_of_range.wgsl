// Samples as the tutorial does, with the tutorial's mistake: it never tests whether the map covers
// the position.
//
// It replaces the library's own `shadow_sun`. Requires: bias_manual.

@group(1) @binding(0) var<uniform> sun_view: ShadowViewUniform;
@group(1) @binding(1) var sun_map: texture_depth_2d_array;
@group(1) @binding(2) var clamping_sampler: sampler_comparison;

fn shadow_sun(position: vec3<f32>, normal: vec3<f32>) -> f32 {
    let receiver = shadow_receiver_manual_directional(sun_view, position, normal);
    // Beyond the map's sides the sampler reads the texel at the edge. Beyond its far plane the
    // receiver's depth is below every depth that a map can contain, so that whatever it contains
    // seems to lie in front. `receiver.inside` would be false there, and is not tested.
    let uv = receiver.texel * receiver.uv_per_texel;
    return textureSampleCompareLevel(sun_map, clamping_sampler, uv, receiver.layer, receiver.depth);
}
