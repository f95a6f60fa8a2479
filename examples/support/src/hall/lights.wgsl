// Contains the hall's fragment stage. The text before this one defines `shade`, Blinn-Phong under
// the sun, and the one before that `shadow_sun`, `shadow_spots` and `shadow_lamps`.

struct Light {
    place: vec3<f32>,
    range: f32,
    color: vec3<f32>,
    // Is that of a spot light's cone; -1 for a point light.
    cone_cosine: f32,
    direction: vec3<f32>,
}

struct Lights {
    spots: array<Light, 4>,
    lamps: array<Light, 32>,
}

@group(2) @binding(0) var<uniform> lights: Lights;

// Returns what a light sends to a surface if nothing is between them.
fn unshadowed(light: Light, surface: Surface) -> vec3<f32> {
    let to_light = light.place - surface.position;
    let reached = max(1.0 - dot(to_light, to_light) / (light.range * light.range), 0.0);
    let toward_light = normalize(to_light);
    let facing = max(dot(surface.normal, toward_light), 0.0);
    // The light fades toward the rim of the cone.
    let along = -dot(toward_light, light.direction);
    let inside = smoothstep(light.cone_cosine, light.cone_cosine + 0.06, along);
    let cone = select(inside, 1.0, light.cone_cosine < 0.0);
    return light.color * (reached * reached * facing * cone);
}

fn lit_hall(surface: Surface) -> vec3<f32> {
    var color = shade(surface, shadow_sun(surface.position, surface.normal));
    // A light's number here is its slot in the pool. Where a light does not reach the surface, its
    // shadow is not sampled.
    for (var i = 0u; i < 4u; i++) {
        let light = unshadowed(lights.spots[i], surface);
        if any(light > vec3<f32>(0.0)) {
            color += surface.albedo * light * shadow_spots(i, surface.position, surface.normal);
        }
    }
    for (var i = 0u; i < 32u; i++) {
        let light = unshadowed(lights.lamps[i], surface);
        if any(light > vec3<f32>(0.0)) {
            color += surface.albedo * light * shadow_lamps(i, surface.position, surface.normal);
        }
    }
    return color;
}

@fragment
fn fragment(surface: Surface) -> @location(0) vec4<f32> {
    return vec4<f32>(lit_hall(surface), 1.0);
}
