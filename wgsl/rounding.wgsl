// Bounds the rounding of what a local light shines on.
//
// CPU reference: src/receive/reference. Requires: view, place.

// Is the rounding of a render coordinate of a caster or a receiver, relative to the coordinate: 4u,
// with u = 2^-24.
const SHADOW_POSITION_ROUNDING: f32 = 2.3841858e-7;

// Returns the world distance by which a tangent plane is moved toward a local light so that
// rounding cannot leave it behind the surface; `height` is the signed distance of the plane from
// the light. Everything that a receiver is compared with is no farther from the light than the
// receiver, so the rounding grows with the receiver's own distance. Where the light is next to the
// plane, the plane moves by half of its way to the light.
fn shadow_local_rounding(view: ShadowViewUniform, place: ShadowPlace, height: f32) -> f32 {
    let farthest = max(max(abs(place.light.x), abs(place.light.y)), -place.light.z);
    return min(view.offset_world + SHADOW_POSITION_ROUNDING * farthest, 0.5 * abs(height));
}
