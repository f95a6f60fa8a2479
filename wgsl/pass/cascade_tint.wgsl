// A picture tinted by the view that serves each pixel: drawn over the engine's own, which it multiplies.
//
// Rust twin: src/cascade_tint.rs. Requires: view, fullscreen.

struct ShadowTint {
    // Render space from the clip space of the picture's camera.
    render_from_clip: mat4x4<f32>,
    // x is the number of views. A vector, since uniforms are multiples of 16 bytes in OpenGL ES 3.0.
    count: vec4<u32>,
}

@group(0) @binding(0) var<uniform> shadow_tint: ShadowTint;
@group(0) @binding(1) var<uniform> shadow_tint_views: array<ShadowViewUniform, 8>;
@group(0) @binding(2) var shadow_tint_depth: texture_2d<f32>;
@group(0) @binding(3) var shadow_tint_sampler: sampler;

// Red, green, blue, yellow, cyan, magenta, orange, violet; grey where no view serves the place.
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
    // A sample and not a gather, which GLSL ES 3.00 lacks, nor a load; see `texels_by_samples`.
    let size = vec2<f32>(textureDimensions(shadow_tint_depth));
    let texel = min(floor(vertex.uv * size), size - 1.0);
    let depth = textureSampleLevel(shadow_tint_depth, shadow_tint_sampler, (texel + 0.5) / size, 0.0).x;
    let ndc = vec2<f32>(vertex.uv.x * 2.0 - 1.0, 1.0 - vertex.uv.y * 2.0);
    let place = shadow_tint.render_from_clip * vec4<f32>(ndc, depth, 1.0);
    // Nothing was drawn here: the sky, by either convention of depth.
    if depth == 0.0 || depth == 1.0 || place.w == 0.0 {
        return vec4<f32>(1.0);
    }
    let position = place.xyz / place.w;
    for (var view = 0u; view < shadow_tint.count.x; view++) {
        if shadow_view_holds(shadow_tint_views[view], position) {
            return vec4<f32>(shadow_tint_color(view), 1.0);
        }
    }
    return vec4<f32>(shadow_tint_color(8u), 1.0);
}
