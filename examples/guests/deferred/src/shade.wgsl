// Adds up the lights; of shadows it reads one texture. `camera.wgsl` precedes it.

const PI: f32 = 3.141592653589793;

struct Lights {
    toward_sun: vec4<f32>,
    spot_position: vec4<f32>,
    spot_direction: vec4<f32>,
    lamp_position: vec4<f32>,
    // Are the cosines of the cone and the ranges of spot and lamp.
    cone_and_ranges: vec4<f32>,
}
@group(0) @binding(1) var<uniform> lights: Lights;
@group(0) @binding(2) var depths: texture_depth_2d;
@group(0) @binding(3) var normals: texture_2d<f32>;
@group(0) @binding(4) var albedos: texture_2d<f32>;
@group(0) @binding(5) var visibility: texture_2d<f32>;
@group(0) @binding(6) var image: texture_storage_2d<rgba8unorm, write>;

@compute @workgroup_size(8, 8) fn shade(@builtin(global_invocation_id) id: vec3<u32>) {
    let size = textureDimensions(depths);
    if any(id.xy >= size) {
        return;
    }
    let depth = textureLoad(depths, id.xy, 0);
    var radiance = vec3(0.10, 0.13, 0.18);
    if depth > 0.0 {
        let position = position_of_pixel(id.xy, size, depth);
        let normal = normalize(textureLoad(normals, id.xy, 0).xyz);
        let visible = textureLoad(visibility, id.xy, 0);

        let sun = max(dot(normal, lights.toward_sun.xyz), 0.0);
        let to_spot = lights.spot_position.xyz - position;
        let cosine = dot(normalize(-to_spot), lights.spot_direction.xyz);
        let cone = smoothstep(lights.cone_and_ranges.x, lights.cone_and_ranges.y, cosine);
        let spot = cone * local_light(to_spot, normal, lights.cone_and_ranges.z);
        let to_lamp = lights.lamp_position.xyz - position;
        let lamp = local_light(to_lamp, normal, lights.cone_and_ranges.w);
        let irradiance = vec3(0.25, 0.28, 0.33) + vec3(2.0, 1.9, 1.7) * sun * visible.x
            + vec3(0.8, 1.6, 2.4) * spot * visible.y + vec3(2.4, 1.4, 0.6) * lamp * visible.z;
        radiance = textureLoad(albedos, id.xy, 0).rgb / PI * irradiance;
    }
    textureStore(image, id.xy, vec4(pow(radiance, vec3(1.0 / 2.2)), 1.0));
}

fn local_light(way: vec3<f32>, normal: vec3<f32>, range: f32) -> f32 {
    let part = min(length(way) / range, 1.0);
    return max(dot(normal, normalize(way)), 0.0) * pow(1.0 - part * part, 2.0);
}
