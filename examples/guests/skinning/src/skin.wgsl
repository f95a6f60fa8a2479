// Moves vertices by the joints of a skin and the weight of a morph target. The engine puts it before
// its own vertex stage, and before that of the caster.

struct Pose {
    render_from_bind: array<mat4x4<f32>, 16>,
    // Is the weight of the morph target in x.
    morph: vec4<f32>,
}

@group(1) @binding(0) var<uniform> pose: Pose;

struct SkinVertex {
    @location(0) position: vec3<f32>,
    @location(1) normal: vec3<f32>,
    @location(2) morph_offset: vec3<f32>,
    @location(3) joints: vec4<u32>,
    @location(4) weights: vec4<f32>,
}

fn render_from_bind(vertex: SkinVertex) -> mat4x4<f32> {
    return vertex.weights.x * pose.render_from_bind[vertex.joints.x]
        + vertex.weights.y * pose.render_from_bind[vertex.joints.y]
        + vertex.weights.z * pose.render_from_bind[vertex.joints.z]
        + vertex.weights.w * pose.render_from_bind[vertex.joints.w];
}

fn skinned_position(vertex: SkinVertex) -> vec3<f32> {
    let morphed = vertex.position + pose.morph.x * vertex.morph_offset;
    return (render_from_bind(vertex) * vec4<f32>(morphed, 1.0)).xyz;
}
