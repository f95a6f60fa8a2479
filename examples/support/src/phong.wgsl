// Computes Blinn-Phong with one light. An example puts its fragment stage behind this text, and the
// visibility functions that it calls in front.

struct Frame {
    clip_from_render: mat4x4<f32>,
    // Is the direction toward a sun (w = 0), or the position of a point light (w = 1).
    light: vec4<f32>,
    light_color: vec3<f32>,
    // Is the distance at which a point light ends.
    light_range: f32,
    ambient: vec3<f32>,
    eye: vec3<f32>,
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
    // Matrices here are rotations after scales, for which the inverse transpose is the matrix
    // divided by its squared scales. A common factor has no effect: with it removed, the scales are
    // ones where all are equal.
    let squared = vec3<f32>(
        dot(column_x, column_x),
        dot(column_y, column_y),
        dot(column_z, column_z),
    );
    let relative = squared / max(squared.x, max(squared.y, squared.z));
    var surface: Surface;
    surface.clip = frame.clip_from_render * place;
    surface.position = place.xyz;
    surface.normal = normalize((render_from_model * vec4<f32>(normal / relative, 0.0)).xyz);
    surface.albedo = material.rgb;
    surface.checker = material.a;
    return surface;
}

// Returns squares of side 1, averaged over a pixel: between -1 and 1.
fn checker(place: vec2<f32>) -> f32 {
    let width = max(fwidth(place), vec2<f32>(1e-4));
    let left = abs(fract((place - 0.5 * width) * 0.5) - 0.5);
    let right = abs(fract((place + 0.5 * width) * 0.5) - 0.5);
    let stripes = 2.0 * (left - right) / width;
    return stripes.x * stripes.y;
}

// Returns the two coordinates along the axis-aligned plane that the surface is closest to.
fn along_surface(surface: Surface) -> vec2<f32> {
    let steepness = abs(surface.normal);
    let wall = select(surface.position.xy, surface.position.zy, steepness.x > steepness.z);
    return select(wall, surface.position.xz, steepness.y > max(steepness.x, steepness.z));
}

// Returns the colour of a surface of which the fraction `visibility` of the light is visible.
fn shade(surface: Surface, visibility: f32) -> vec3<f32> {
    let albedo = surface.albedo * (1.0 + surface.checker * checker(along_surface(surface)));
    var toward_light = frame.light.xyz;
    var strength = 1.0;
    if frame.light.w != 0.0 {
        let to_lamp = frame.light.xyz - surface.position;
        toward_light = normalize(to_lamp);
        strength = max(1.0 - dot(to_lamp, to_lamp) / (frame.light_range * frame.light_range), 0.0);
    }
    let facing = dot(surface.normal, toward_light);
    let halfway = normalize(toward_light + normalize(frame.eye - surface.position));
    let specular = 0.15 * pow(max(dot(surface.normal, halfway), 0.0), 64.0);
    let lit = strength * select(0.0, visibility, facing > 0.0);
    return albedo * (frame.ambient + frame.light_color * (lit * facing)) + frame.light_color * (lit * specular);
}
