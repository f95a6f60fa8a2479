// The textbook's lookup, with the textbook's mistake: it never asks whether the map knows anything of the place.
//
// Stands where the library's own `shadow_sun` stands otherwise. Requires: bias_manual.

@group(1) @binding(0) var<uniform> sun_view: ShadowViewUniform;
@group(1) @binding(1) var sun_map: texture_depth_2d_array;
@group(1) @binding(2) var clamping_sampler: sampler_comparison;

fn shadow_sun(position: vec3<f32>, normal: vec3<f32>) -> f32 {
    let receiver = shadow_receiver_manual(sun_view, position, normal);
    // Beyond the map's sides the sampler takes the texel at the edge. Beyond its far plane the receiver's depth is below all
    // that a map can hold, so that whatever it holds seems to lie in front. `receiver.inside` would tell, and is not asked.
    let uv = receiver.texel / receiver.map_size;
    return textureSampleCompareLevel(sun_map, clamping_sampler, uv, receiver.layer, receiver.depth);
}
