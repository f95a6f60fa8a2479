// Contains the engine's own bindings and names. The library's modules precede this text and take them as arguments.

@group(1) @binding(0) var depth_sampler: sampler;
@group(1) @binding(1) var sun_depths: texture_depth_2d_array;
@group(1) @binding(2) var<uniform> sun_view: ShadowViewUniform;
@group(1) @binding(3) var lamp_depths: texture_depth_2d_array;
@group(1) @binding(4) var<uniform> lamp_views: array<ShadowViewUniform, 6>;

fn sunlight(position: vec3<f32>, normal: vec3<f32>) -> f32 {
    let receiver = shadow_receiver_plane_directional(sun_view, position, normal);
    if !receiver.inside {
        return 1.0;
    }
    // Ends the shadows at the camera's distance limit, and fades them before it.
    let visibility = shadow_filter_tent3(sun_depths, depth_sampler, receiver);
    return shadow_limited_by_depth(sun_view, position, visibility);
}

fn lamplight(position: vec3<f32>, normal: vec3<f32>) -> f32 {
    let face = shadow_cube_face(position - lamp_views[0].anchor);
    let receiver = shadow_receiver_plane_local(lamp_views[face], position, normal);
    if !receiver.inside {
        return 1.0;
    }
    // Of a lamp with a `fade`, `shadow_limited_by_distance` would be called here.
    return shadow_filter_tent3(lamp_depths, depth_sampler, receiver);
}
