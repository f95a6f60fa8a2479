// Is the vertex stage of a skinned caster.

@vertex
fn skinned_caster(vertex: SkinVertex) -> @builtin(position) vec4<f32> {
    return shadow_caster_clip(skinned_position(vertex));
}
