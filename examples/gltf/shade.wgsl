// Computes Blinn-Phong with the library's visibility. It is put together with the WGSL of
// ShadowBindings and `visibility_of_light`.

struct Frame {
    clip_from_render: mat4x4<f32>,
    light_count: u32,
    exposure: f32,
}

struct Light {
    intensity: vec3<f32>,
    // Is 0 for a directional light and 1 for a point or spot light.
    local: u32,
    direction: vec3<f32>,
    range: f32,
    position: vec3<f32>,
    // Are scale and offset by which the cosine fades from 0 to 1 over the rim of a cone.
    cone_scale: f32,
    cone_offset: f32,
    // Are the number of its maps, counted from 1, and its index among their lights; 0 maps for a
    // light without shadows.
    maps: u32,
    index: u32,
}

struct Material {
    base_color: vec4<f32>,
    alpha_cutoff: f32,
}

@group(0) @binding(0) var<uniform> frame: Frame;
@group(0) @binding(1) var<uniform> lights: array<Light, MAX_LIGHTS>;
@group(2) @binding(0) var<uniform> material: Material;
@group(2) @binding(1) var base_texture: texture_2d<f32>;
@group(2) @binding(2) var base_sampler: sampler;

struct Surface {
    @builtin(position) clip: vec4<f32>,
    @location(0) position: vec3<f32>,
    @location(1) normal: vec3<f32>,
    @location(2) uv: vec2<f32>,
}

@vertex
fn vertex(
    @location(0) position: vec3<f32>,
    @location(1) normal: vec3<f32>,
    @location(2) uv: vec2<f32>,
    @location(3) column_x: vec4<f32>,
    @location(4) column_y: vec4<f32>,
    @location(5) column_z: vec4<f32>,
    @location(6) column_w: vec4<f32>,
) -> Surface {
    let render_from_model = mat4x4<f32>(column_x, column_y, column_z, column_w);
    // Normals are transformed by the cofactors, which are correct for any scale, uneven or
    // mirrored.
    let cofactors = mat3x3<f32>(
        cross(column_y.xyz, column_z.xyz),
        cross(column_z.xyz, column_x.xyz),
        cross(column_x.xyz, column_y.xyz),
    );
    let place = render_from_model * vec4<f32>(position, 1.0);
    var surface: Surface;
    surface.clip = frame.clip_from_render * place;
    surface.position = place.xyz;
    surface.normal = cofactors * normal;
    surface.uv = uv;
    return surface;
}

// Holds the direction toward the light, and the part of its intensity that arrives.
struct Arrival {
    toward_light: vec3<f32>,
    share: f32,
}

fn arrival(light: Light, position: vec3<f32>) -> Arrival {
    if light.local == 0u {
        return Arrival(-light.direction, 1.0);
    }
    let to_light = light.position - position;
    let distance_squared = max(dot(to_light, to_light), 1e-12);
    let toward_light = to_light * inverseSqrt(distance_squared);
    // KHR_lights_punctual specifies this: inverse square, windowed by the range, and smooth between
    // inner and outer cone.
    let reach = distance_squared / (light.range * light.range);
    let window = clamp(1.0 - reach * reach, 0.0, 1.0);
    let cone = dot(light.direction, -toward_light) * light.cone_scale + light.cone_offset;
    let fade = clamp(cone, 0.0, 1.0);
    return Arrival(toward_light, window * fade * fade / distance_squared);
}

fn base_color(uv: vec2<f32>) -> vec4<f32> {
    return material.base_color * textureSample(base_texture, base_sampler, uv);
}

@fragment
fn shade(surface: Surface) -> @location(0) vec4<f32> {
    let base = base_color(surface.uv);
    let facet = shadow_geometric_normal(surface.position, -surface.position);
    if base.a < material.alpha_cutoff {
        discard;
    }
    let smooth_length = length(surface.normal);
    var normal = facet;
    if smooth_length > 0.0 {
        normal = surface.normal / smooth_length;
        normal *= select(-1.0, 1.0, dot(normal, facet) >= 0.0);
    }
    let toward_eye = normalize(-surface.position);
    // The ambient light is a little sky from above and ground from below.
    var color = base.rgb * mix(vec3<f32>(0.10, 0.09, 0.08), vec3<f32>(0.20, 0.23, 0.28), normal.y * 0.5 + 0.5);
    for (var i = 0u; i < frame.light_count; i++) {
        let light = lights[i];
        let arriving = arrival(light, surface.position);
        let facing = max(dot(normal, arriving.toward_light), 0.0);
        let halfway = normalize(arriving.toward_light + toward_eye);
        let shine = pow(max(dot(normal, halfway), 0.0), 64.0) * 0.2 * select(0.0, 1.0, facing > 0.0);
        let irradiance = light.intensity * (arriving.share * frame.exposure);
        let visibility = visibility_of_light(light.maps, light.index, surface.position, facet);
        color += irradiance * visibility * (base.rgb * facing + shine);
    }
    return vec4<f32>(color, 1.0);
}

// Writes the visibility of the first light where the facet faces it and its light arrives, and 1
// elsewhere.
@fragment
fn visibility(surface: Surface) -> @location(0) vec4<f32> {
    let alpha = base_color(surface.uv).a;
    let facet = shadow_geometric_normal(surface.position, -surface.position);
    if alpha < material.alpha_cutoff {
        discard;
    }
    let arriving = arrival(lights[0], surface.position);
    let reached = arriving.share > 0.0 && dot(facet, arriving.toward_light) > 0.0;
    let visible = visibility_of_light(lights[0].maps, lights[0].index, surface.position, facet);
    return vec4<f32>(select(1.0, visible, reached));
}
