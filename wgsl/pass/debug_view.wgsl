// Depth maps as grey levels: black at the light, white at the end of its range and where nothing
// casts. The range is here that up to which receivers are seen.
//
// CPU counterpart: src/debug/view.rs. Requires: view, cube_face, fullscreen.

struct ShadowDebugView {
    // Holds 1 in x where depth is near / distance (a local light), and 0 where it is linear (a
    // directional one). It is a vector, since uniforms are multiples of 16 bytes in OpenGL ES 3.0.
    local: vec4<u32>,
    // Is the part of the layer that is shown: its first texel, and its size in texels.
    texels: vec4<f32>,
}

@group(0) @binding(0) var<uniform> shadow_debug: ShadowDebugView;
@group(0) @binding(1) var<uniform> shadow_debug_views: array<ShadowViewUniform, 6>;
@group(0) @binding(2) var shadow_debug_map: texture_2d_array<f32>;
@group(0) @binding(3) var shadow_debug_sampler: sampler;

// Returns the distance from the light along the ray through `texel` (from the middle), as a
// fraction of the light's reach. `tangents` is the ray's position in the plane of the map of a
// local light.
fn shadow_debug_grey(view: ShadowViewUniform, texel: vec2<f32>, tangents: vec2<f32>) -> f32 {
    let last = view.map_size - 1.0;
    let inside = clamp(floor(texel + view.mapping.middle), vec2<f32>(0.0), vec2<f32>(last));
    let uv = (inside + 0.5) * view.uv_per_texel;
    // This is a sample, since GLSL ES 3.00 has no gather, and since loads fail as
    // `texels_by_samples` describes.
    let depth = textureSampleLevel(shadow_debug_map, shadow_debug_sampler, uv, view.layer, 0.0).x;
    if shadow_debug.local.x == 0u {
        return 1.0 - depth;
    }
    // The depth is the near distance over the distance along the axis.
    let along_axis = view.mapping.depth_scale / max(depth, 1e-30);
    return clamp(along_axis * length(vec3<f32>(tangents, 1.0)) / view.range, 0.0, 1.0);
}

// Draws the first view of the list as it is stored in its layer.
@fragment
fn shadow_debug_layer(vertex: ShadowFullscreenVertex) -> @location(0) vec4<f32> {
    let view = shadow_debug_views[0];
    let shown = shadow_debug.texels;
    let texel = shown.xy + vertex.uv * shown.zw - view.mapping.middle;
    // A view into which nothing casts has texels without a size.
    if view.mapping.texel_size.x <= 0.0 {
        return vec4<f32>(1.0);
    }
    let tangents = (texel - view.mapping.texel_offset) * view.mapping.texel_size;
    return vec4<f32>(vec3<f32>(shadow_debug_grey(view, texel, tangents)), 1.0);
}

// Draws the six faces of a cube, unfolded around the one that looks along -z: +y above it, -x to
// the left, +x to the right, +z outermost to the right, and -y below.
@fragment
fn shadow_debug_cross(vertex: ShadowFullscreenVertex) -> @location(0) vec4<f32> {
    let cell = vec2<i32>(floor(vertex.uv * vec2<f32>(4.0, 3.0)));
    let within = fract(vertex.uv * vec2<f32>(4.0, 3.0)) * 2.0 - 1.0;
    let right = within.x;
    let up = -within.y;
    var ray: vec3<f32>;
    if cell.y == 1 {
        switch cell.x {
            case 0: { ray = vec3<f32>(-1.0, up, -right); }
            case 1: { ray = vec3<f32>(right, up, -1.0); }
            case 2: { ray = vec3<f32>(1.0, up, right); }
            default: { ray = vec3<f32>(-right, up, 1.0); }
        }
    } else if cell.x == 1 {
        ray = select(vec3<f32>(right, -1.0, -up), vec3<f32>(right, 1.0, up), cell.y == 0);
    } else {
        return vec4<f32>(vec3<f32>(0.5), 1.0);
    }
    let face = shadow_face(ray);
    let view = shadow_debug_views[face.index];
    let ray_light = shadow_along_face(face, ray);
    let tangents = ray_light.xy / -ray_light.z;
    let texel = tangents * view.mapping.texel_scale + view.mapping.texel_offset;
    if !all(abs(texel) < view.mapping.inner) {
        return vec4<f32>(1.0);
    }
    return vec4<f32>(vec3<f32>(shadow_debug_grey(view, texel, tangents)), 1.0);
}
