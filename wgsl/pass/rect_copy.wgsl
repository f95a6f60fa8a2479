// Copies depths to the same texels of another map, within the scissor rectangle of a depth pass.

@group(0) @binding(0) var shadow_copied_map: texture_2d_array<f32>;
@group(0) @binding(1) var shadow_copied_sampler: sampler;

// Returns the depth of the texel of the other map. This is a sample of the nearest texel, since
// loads fail as `texels_by_samples` describes.
@fragment
fn shadow_copy_fragment(vertex: ShadowFullscreenVertex) -> @builtin(frag_depth) f32 {
    let uv = vertex.clip.xy / vec2<f32>(textureDimensions(shadow_copied_map));
    return textureSampleLevel(shadow_copied_map, shadow_copied_sampler, uv, 0, 0.0).x;
}
