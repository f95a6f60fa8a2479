// Draws colours that tell which view covers each pixel. The pass multiplies the engine's image by
// them.
//
// CPU counterpart: src/debug/cascade_tint.rs. Requires: view, place, fullscreen.

struct ShadowTint {
    // Transforms the clip space of the image's camera to render space.
    render_from_clip: mat4x4<f32>,
    // Holds the number of views in x. It is a vector, since uniforms are multiples of 16 bytes in
    // OpenGL ES 3.0.
    count: vec4<u32>,
}

@group(0) @binding(0) var<uniform> shadow_tint: ShadowTint;
@group(0) @binding(1) var<uniform> shadow_tint_views: array<ShadowViewUniform, 8>;
@group(0) @binding(2) var shadow_tint_depth: texture_2d<f32>;
@group(0) @binding(3) var shadow_tint_sampler: sampler;

// Returns the colour of a view: red, green, blue, yellow, cyan, magenta, orange or violet, and grey
// where no view covers the position.
fn shadow_tint_color(view: u32) -> vec3<f32> {
    switch view {
        case 0u: { return vec3<f32>(1.0, 0.35, 0.3); }
        case 1u: { return vec3<f32>(0.35, 1.0, 0.3); }
        case 2u: { return vec3<f32>(0.35, 0.5, 1.0); }
        case 3u: { return vec3<f32>(1.0, 0.9, 0.25); }
        case 4u: { return vec3<f32>(0.3, 0.95, 1.0); }
        case 5u: { return vec3<f32>(1.0, 0.4, 0.95); }
        case 6u: { return vec3<f32>(1.0, 0.6, 0.25); }
        case 7u: { return vec3<f32>(0.65, 0.4, 1.0); }
        default: { return vec3<f32>(0.6); }
    }
}

@fragment
fn shadow_tint_fragment(vertex: ShadowFullscreenVertex) -> @location(0) vec4<f32> {
    // This is a sample, since GLSL ES 3.00 has no gather, and since loads fail as
    // `texels_by_samples` describes.
    let size = vec2<f32>(textureDimensions(shadow_tint_depth));
    let texel = min(floor(vertex.uv * size), size - 1.0);
    let uv = (texel + 0.5) / size;
    let depth = textureSampleLevel(shadow_tint_depth, shadow_tint_sampler, uv, 0.0).x;
    let ndc = vec2<f32>(vertex.uv.x * 2.0 - 1.0, 1.0 - vertex.uv.y * 2.0);
    let homogeneous = shadow_tint.render_from_clip * vec4<f32>(ndc, depth, 1.0);
    // A depth at either end of the range, whichever convention the camera has, means that nothing
    // was drawn: the sky.
    if depth == 0.0 || depth == 1.0 || homogeneous.w == 0.0 {
        return vec4<f32>(1.0);
    }
    let position = homogeneous.xyz / homogeneous.w;
    for (var view = 0u; view < shadow_tint.count.x; view++) {
        if shadow_view_holds(shadow_tint_views[view], position) {
            return vec4<f32>(shadow_tint_color(view), 1.0);
        }
    }
    return vec4<f32>(shadow_tint_color(8u), 1.0);
}
