// Blinn-Phong with one sun. `shadow_sun` is what is put in front of this text.

struct Frame {
    clip_from_render: mat4x4<f32>,
    eye: vec4<f32>,
    toward_light: vec4<f32>,
}

@group(0) @binding(0) var<uniform> frame: Frame;

struct Surface {
    @builtin(position) clip: vec4<f32>,
    @location(0) position: vec3<f32>,
    @location(1) normal: vec3<f32>,
    @location(2) albedo: vec3<f32>,
    @location(3) checker: f32,
}

@vertex
fn vertex(
    @location(0) position: vec3<f32>,
    @location(1) normal: vec3<f32>,
    @location(2) column_x: vec4<f32>,
    @location(3) column_y: vec4<f32>,
    @location(4) column_z: vec4<f32>,
    @location(5) column_w: vec4<f32>,
    @location(6) material: vec4<f32>,
) -> Surface {
    let render_from_model = mat4x4<f32>(column_x, column_y, column_z, column_w);
    let place = render_from_model * vec4<f32>(position, 1.0);
    var surface: Surface;
    surface.clip = frame.clip_from_render * place;
    surface.position = place.xyz;
    // All scales are uniform, so that normals turn as positions do.
    surface.normal = normalize((render_from_model * vec4<f32>(normal, 0.0)).xyz);
    surface.albedo = material.rgb;
    surface.checker = material.a;
    return surface;
}

// Squares of side 1, averaged over a pixel: between -1 and 1.
fn checker(place: vec2<f32>) -> f32 {
    let width = max(fwidth(place), vec2<f32>(1e-4));
    let left = abs(fract((place - 0.5 * width) * 0.5) - 0.5);
    let right = abs(fract((place + 0.5 * width) * 0.5) - 0.5);
    let stripes = 2.0 * (left - right) / width;
    return stripes.x * stripes.y;
}

@fragment
fn fragment_picture(surface: Surface) -> @location(0) vec4<f32> {
    let albedo = surface.albedo * (1.0 + surface.checker * checker(surface.position.xz));
    let toward_light = frame.toward_light.xyz;
    let facing = dot(surface.normal, toward_light);
    let halfway = normalize(toward_light + normalize(frame.eye.xyz - surface.position));
    let specular = 0.15 * pow(max(dot(surface.normal, halfway), 0.0), 64.0);
    let lit = select(0.0, shadow_sun(surface.position, surface.normal), facing > 0.0);
    return vec4<f32>(albedo * (0.2 + lit * facing) + lit * specular, 1.0);
}

// The visibility alone, for measuring.
@fragment
fn fragment_visibility(surface: Surface) -> @location(0) vec4<f32> {
    return vec4<f32>(shadow_sun(surface.position, surface.normal), 0.0, 0.0, 1.0);
}
