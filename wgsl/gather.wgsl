// Reads four raw depths at once and compares each with the receiver's reference depth at that texel.
//
// CPU reference: src/receive/reference.rs. Requires: view, texels.

// Returns 1 where lit and 0 where shadowed, for the texels (first), (first + x), (first + y), (first + x + y).
fn shadow_gather(
    map: ShadowMap,
    map_sampler: sampler,
    receiver: ShadowReceiver,
    first: vec2<f32>,
) -> vec4<f32> {
    let lit = shadow_references(receiver, first) >= shadow_texels(map, map_sampler, receiver, first);
    return select(vec4<f32>(0.0), vec4<f32>(1.0), lit);
}

// Returns the receiver's reference depths at four texels, in the same order. They are never farther from the light than
// the receiver itself.
fn shadow_references(receiver: ShadowReceiver, first: vec2<f32>) -> vec4<f32> {
    let to_first = first + 0.5 - receiver.texel;
    let rise = dot(receiver.gradient, to_first);
    let along = vec4<f32>(
        0.0,
        receiver.gradient.x,
        receiver.gradient.y,
        receiver.gradient.x + receiver.gradient.y,
    );
    return receiver.depth + max(vec4<f32>(rise) + along, vec4<f32>(0.0));
}

// Returns a visibility with a sharper edge: its ramp is stretched around one half.
fn shadow_sharpen(visibility: f32, sharpness: f32) -> f32 {
    return clamp((visibility - 0.5) * sharpness + 0.5, 0.0, 1.0);
}
