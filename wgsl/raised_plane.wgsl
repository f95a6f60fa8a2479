// Moves the tangent plane of a receiver under a local light, for the biases of these lights.
//
// With h = n · p, the position p being relative to the light, the plane of normal n meets the
// direction of tangents (x, y) at the distance w along the axis where near / w = near (nx x + ny y
// - nz) / h. Moving the plane along its normal changes h alone.
//
// CPU reference: src/receive/reference. Requires: view, place.

// Is the rounding of a render coordinate of a caster or a receiver, relative to the coordinate: 4u,
// with u = 2^-24.
const SHADOW_POSITION_ROUNDING: f32 = 2.3841858e-7;

// Describes the receiver on its plane after the plane has been moved.
struct ShadowRaisedPlane {
    // Is the change of depth per texel along x and y; steep without a limit where the plane is next
    // to the light.
    gradient: vec2<f32>,
    // Is how far the receiver moves across the map, in texels: by the tangents of the offset.
    shift: vec2<f32>,
    // Is the ndc depth of the moved plane at the texel to which the receiver moves, and the
    // rounding of a comparison.
    depth: f32,
}

// Returns the world distance by which a tangent plane is moved toward a local light so that
// rounding cannot leave it behind the surface; `height` is the signed distance of the plane from
// the light. Everything that a receiver is compared with is no farther from the light than the
// receiver, so the rounding grows with the receiver's own distance. Where the light is next to the
// plane, the plane moves by half of its way to the light.
fn shadow_local_rounding(view: ShadowViewUniform, place: ShadowPlace, height: f32) -> f32 {
    let across = abs(place.position_light.xy);
    let farthest = max(max(across.x, across.y), -place.position_light.z);
    return min(view.offset_world + SHADOW_POSITION_ROUNDING * farthest, 0.5 * abs(height));
}

// Returns a receiver's plane moved by `offset` world units along its normal and by `rounding`
// toward the light. The normal is along the axes of light space, and `height` is the plane's signed
// distance from the light.
fn shadow_raised_plane(
    mapping: ShadowMapping,
    place: ShadowPlace,
    normal_light: vec3<f32>,
    height: f32,
    rounding: f32,
    offset: f32,
) -> ShadowRaisedPlane {
    let moved = height + select(-rounding, rounding, height < 0.0) + offset;
    // A plane through the light has no gradient, nor does one whose normal is zero.
    let inverse_height = select(0.0, 1.0 / moved, abs(moved) > 0.0);
    let gradient = normal_light.xy * mapping.texel_size * (mapping.depth_scale * inverse_height);
    let shift = normal_light.xy * (offset * place.inverse_w) * mapping.texel_scale;
    let raised = place.depth * ((height - moved) * inverse_height + mapping.rounding);
    return ShadowRaisedPlane(gradient, shift, place.depth + (raised + dot(gradient, shift)));
}
