// Is the guest's own shading: Lambert's law under all lights of kiss3d's collection, with their
// shadows. The library's functions and the object's precede it.

const PI: f32 = 3.141592653589793;

struct Light {
    position: vec3<f32>,
    // Is 0 for a sun, 1 for a spot light, 2 for a point light.
    kind: u32,
    direction: vec3<f32>,
    // Is the slot of the light's shadows; one that no light has where it casts none.
    slot: u32,
    color: vec3<f32>,
    range: f32,
    cone_cosines: vec2<f32>,
}
struct Frame {
    clip_from_world: mat4x4<f32>,
    eye: vec3<f32>,
    light_count: u32,
    ambient: vec4<f32>,
    // Cuts off what lies behind a mirror.
    clip_plane: vec4<f32>,
    lights: array<Light, 8>,
}
@group(0) @binding(0) var<uniform> frame: Frame;

struct Surface {
    @builtin(position) clip: vec4<f32>,
    @location(0) position: vec3<f32>,
    @location(1) normal: vec3<f32>,
    @location(2) color: vec4<f32>,
}

@vertex fn surface(
    @location(0) vertex: vec3<f32>, @location(1) offset: vec3<f32>,
    @location(2) x: vec3<f32>, @location(3) y: vec3<f32>, @location(4) z: vec3<f32>,
    @location(5) normal: vec3<f32>, @location(6) color: vec4<f32>,
) -> Surface {
    let position = object_position(vertex, offset, x, y, z);
    let turned = object_turned(normal / object.scale.xyz, x, y, z);
    let clip = frame.clip_from_world * vec4(position, 1.0);
    return Surface(clip, position, turned, object.color * color);
}

@fragment fn shade(in: Surface) -> @location(0) vec4<f32> {
    let toward_viewer = frame.eye - in.position;
    let facet = shadow_geometric_normal(in.position, toward_viewer);
    if dot(frame.clip_plane.xyz, in.position) + frame.clip_plane.w < 0.0 {
        discard;
    }
    let smooth_normal = normalize(in.normal);
    let normal = smooth_normal * select(-1.0, 1.0, dot(smooth_normal, facet) > 0.0);

    var radiance = frame.ambient.rgb;
    for (var i = 0u; i < frame.light_count; i++) {
        let light = frame.lights[i];
        var toward_light = -light.direction;
        var falloff = 1.0;
        if light.kind > 0u {
            let way = light.position - in.position;
            toward_light = normalize(way);
            let part = min(length(way) / light.range, 1.0);
            falloff = pow(1.0 - part * part, 2.0);
        }
        if light.kind == 1u {
            let inside = dot(-toward_light, light.direction) - light.cone_cosines.y;
            falloff *= pow(saturate(inside / (light.cone_cosines.x - light.cone_cosines.y)), 2.0);
        }
        let cosine = dot(normal, toward_light) * falloff;
        if cosine > 0.0 {
            radiance += light.color * cosine / PI * visibility(light, in.position, facet);
        }
    }
    return vec4(radiance * in.color.rgb, in.color.a);
}

fn visibility(light: Light, position: vec3<f32>, normal: vec3<f32>) -> f32 {
    switch light.kind {
        case 0u: {
            if light.slot == 0u {
                return shadow_sun(position, normal);
            }
            return 1.0;
        }
        case 1u: {
            return shadow_spot(light.slot, position, normal);
        }
        default: {
            return shadow_lamp(light.slot, position, normal);
        }
    }
}
