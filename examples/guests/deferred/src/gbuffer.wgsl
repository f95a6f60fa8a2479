// Writes what the lighting needs of each pixel. The library's module `normal` and `camera.wgsl`
// precede it.

struct Surface {
    @builtin(position) clip: vec4<f32>,
    @location(0) position: vec3<f32>,
    @location(1) albedo: vec3<f32>,
}

@vertex fn surface(
    @location(0) position: vec3<f32>,
    @location(1) x: vec4<f32>, @location(2) y: vec4<f32>,
    @location(3) z: vec4<f32>, @location(4) w: vec4<f32>,
    @location(5) albedo: vec4<f32>,
) -> Surface {
    let position_render = mat4x4(x, y, z, w) * vec4(position, 1.0);
    return Surface(camera.clip_from_render * position_render, position_render.xyz, albedo.rgb);
}

struct Pixel {
    @location(0) normal: vec4<f32>,
    @location(1) albedo: vec4<f32>,
}

@fragment fn write(in: Surface) -> Pixel {
    let normal = shadow_geometric_normal(in.position, camera.eye.xyz - in.position);
    return Pixel(vec4(normal, 0.0), vec4(in.albedo, 1.0));
}
