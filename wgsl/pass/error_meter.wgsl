// Declares what the pass of an error meter reads and writes. The entry point, which calls the light's
// lookup, is that of `template/error_meter.wgsl`.
//
// CPU counterpart: src/meter/places.rs.

struct ShadowMeterPlace {
    // Is a point of a surface in render space.
    position: vec3<f32>,
    // Is the index of the light's slot in a pool.
    slot: u32,
    // Is the geometric normal, of unit length.
    normal: vec3<f32>,
    // Holds the numbers of the texels of its two rays: the first in the low half, the second in the
    // high.
    rays: u32,
}

@group(0) @binding(0) var<storage, read> shadow_meter_places: array<ShadowMeterPlace>;
@group(0) @binding(1) var<storage, read_write> shadow_meter_results: array<vec4<f32>>;
@group(0) @binding(2) var shadow_meter_depths: texture_depth_2d_array;
@group(0) @binding(3) var shadow_meter_sampler: sampler;

// Returns the depth in the texel of a ray. It is gathered: wgpu's OpenGL backend loads from no
// depth texture. The last component of a gather at the corner where four texels meet is the upper
// left one.
fn shadow_meter_depth(ray: u32) -> f32 {
    let size = textureDimensions(shadow_meter_depths);
    let texel = vec2<u32>(ray % size.x, ray / size.x);
    let corner = vec2<f32>(texel + 1u) / vec2<f32>(size);
    return textureGather(shadow_meter_depths, shadow_meter_sampler, corner, 0u).w;
}
