// Draws casters with holes. The library's caster module comes before this text.

struct Mask {
    base_color: vec4<f32>,
    alpha_cutoff: f32,
}

@group(1) @binding(0) var<uniform> mask: Mask;
@group(1) @binding(1) var mask_texture: texture_2d<f32>;
@group(1) @binding(2) var mask_sampler: sampler;

struct Leaf {
    @builtin(position) clip: vec4<f32>,
    @location(0) uv: vec2<f32>,
}

@vertex
fn leaf_vertex(
    @location(0) position: vec3<f32>,
    @location(2) uv: vec2<f32>,
    @location(3) column_x: vec4<f32>,
    @location(4) column_y: vec4<f32>,
    @location(5) column_z: vec4<f32>,
    @location(6) column_w: vec4<f32>,
) -> Leaf {
    let render_from_model = mat4x4<f32>(column_x, column_y, column_z, column_w);
    var leaf: Leaf;
    leaf.clip = shadow_caster_clip((render_from_model * vec4<f32>(position, 1.0)).xyz);
    leaf.uv = uv;
    return leaf;
}

@fragment
fn leaf_fragment(leaf: Leaf) {
    if mask.base_color.a * textureSample(mask_texture, mask_sampler, leaf.uv).a < mask.alpha_cutoff {
        discard;
    }
}
