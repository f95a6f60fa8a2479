// Turns depths and normals into the visibility of all lights, one component each. What
// `ShadowBindings::wgsl` returns and `camera.wgsl` precede it.

@group(0) @binding(1) var depths: texture_depth_2d;
@group(0) @binding(2) var normals: texture_2d<f32>;
@group(0) @binding(3) var visibility: texture_storage_2d<rgba8unorm, write>;

@compute @workgroup_size(8, 8) fn look_up(@builtin(global_invocation_id) id: vec3<u32>) {
    let size = textureDimensions(depths);
    if any(id.xy >= size) {
        return;
    }
    let depth = textureLoad(depths, id.xy, 0);
    var lights = vec4(1.0);
    // Depth is reversed: nothing was drawn where it is 0.
    if depth > 0.0 {
        let position = position_of_pixel(id.xy, size, depth);
        let normal = normalize(textureLoad(normals, id.xy, 0).xyz);
        lights = vec4(
            shadow_sun(position, normal),
            shadow_spot(position, normal),
            shadow_lamp(position, normal),
            1.0,
        );
    }
    textureStore(visibility, id.xy, lights);
}
