// Lights skinned characters and rigid objects by a sun and a lamp.

struct Frame {
    clip_from_render: mat4x4<f32>,
    eye: vec4<f32>,
    toward_sun: vec4<f32>,
    // Is the position of the lamp, and its range.
    lamp: vec4<f32>,
}

@group(0) @binding(0) var<uniform> frame: Frame;

struct Surface {
    @builtin(position) clip: vec4<f32>,
    @location(0) position: vec3<f32>,
    @location(1) normal: vec3<f32>,
    @location(2) albedo: vec3<f32>,
}

@vertex
fn skinned_vertex(vertex: SkinVertex) -> Surface {
    let position = skinned_position(vertex);
    let normal = (render_from_bind(vertex) * vec4<f32>(vertex.normal, 0.0)).xyz;
    let clip = frame.clip_from_render * vec4<f32>(position, 1.0);
    return Surface(clip, position, normal, pose.morph.yzw);
}

struct RigidVertex {
    @location(0) position: vec3<f32>,
    @location(1) normal: vec3<f32>,
    @location(2) column_0: vec4<f32>,
    @location(3) column_1: vec4<f32>,
    @location(4) column_2: vec4<f32>,
    @location(5) column_3: vec4<f32>,
    @location(6) albedo: vec3<f32>,
}

@vertex
fn rigid_vertex(vertex: RigidVertex) -> Surface {
    let render_from_model =
        mat4x4<f32>(vertex.column_0, vertex.column_1, vertex.column_2, vertex.column_3);
    let position = (render_from_model * vec4<f32>(vertex.position, 1.0)).xyz;
    // The objects here are scaled along their axes, so that dividing by the squared scale turns
    // the normal the right way.
    let scale = vec3<f32>(
        dot(vertex.column_0, vertex.column_0),
        dot(vertex.column_1, vertex.column_1),
        dot(vertex.column_2, vertex.column_2),
    );
    let normal = (render_from_model * vec4<f32>(vertex.normal / scale, 0.0)).xyz;
    let clip = frame.clip_from_render * vec4<f32>(position, 1.0);
    return Surface(clip, position, normal, vertex.albedo);
}

struct Pixel {
    @location(0) color: vec4<f32>,
    // Is the visibility of the sun and of the lamp.
    @location(1) visibility: vec4<f32>,
}

fn lit(toward_light: vec3<f32>, normal: vec3<f32>, toward_eye: vec3<f32>, albedo: vec3<f32>) -> vec3<f32> {
    let facing = max(dot(normal, toward_light), 0.0);
    let half_way = normalize(toward_light + toward_eye);
    let shine = 0.12 * pow(max(dot(normal, half_way), 0.0), 32.0);
    return albedo * facing + select(0.0, shine, facing > 0.0);
}

@fragment
fn shade(surface: Surface) -> Pixel {
    let normal = normalize(surface.normal);
    let toward_eye = normalize(frame.eye.xyz - surface.position);
    let geometric = shadow_geometric_normal(surface.position, toward_eye);
    let sun = shadow_sun(surface.position, geometric);
    let lamp = shadow_lamp(surface.position, geometric);
    let toward_lamp = frame.lamp.xyz - surface.position;
    let nearness = max(1.0 - length(toward_lamp) / frame.lamp.w, 0.0);
    let color = 0.12 * surface.albedo
        + 0.8 * sun * lit(frame.toward_sun.xyz, normal, toward_eye, surface.albedo)
        + vec3<f32>(1.0, 0.75, 0.45) * nearness * nearness * lamp
            * lit(normalize(toward_lamp), normal, toward_eye, surface.albedo);
    return Pixel(vec4<f32>(color, 1.0), vec4<f32>(sun, lamp, 0.0, 1.0));
}
