// Gathers from a map, in a pass that is never drawn: whether a device can create its pipeline tells
// whether its shaders can gather.
//
// CPU counterpart: src/receive/texel_access.rs. Requires: fullscreen.

@group(0) @binding(0) var shadow_probe_map: texture_depth_2d_array;
@group(0) @binding(1) var shadow_probe_sampler: sampler;

@fragment
fn shadow_probe_fragment(vertex: ShadowFullscreenVertex) -> @location(0) vec4<f32> {
    return textureGather(shadow_probe_map, shadow_probe_sampler, vertex.uv, 0u);
}
