// Derives the bias from the receiver's tangent plane: each texel of a kernel is compared with the
// depth of the plane at that texel.
//
// Over a plane, ndc depth is affine in map coordinates, for orthographic and perspective views
// alike, so one gradient describes the plane. Filters clamp the extrapolated depth so that it never
// lies farther from the light than the receiver (Dou, Yan, Kerzner, Dai, Wyman 2014, "Adaptive
// Depth Bias for Shadow Maps"). Two errors remain. Rounding is covered by `lateral_error` texels
// along the plane and `depth_error` in depth; facets finer than a texel are covered by an offset of
// `offset_texels` along the normal.
//
// CPU reference: src/receive/reference. Requires: view, place, raised_plane.

// Is the steepest gradient, in depth per texel. Steeper planes cross the whole depth range within a
// fraction of a texel; the limit excludes infinity.
const SHADOW_MAX_GRADIENT: f32 = 1e4;

// Returns the receiver at `position` in a view of a directional light, with the gradient of its
// tangent plane. Position and normal are in render space.
fn shadow_receiver_plane_directional(
    view: ShadowViewUniform,
    position: vec3<f32>,
    normal: vec3<f32>,
) -> ShadowReceiver {
    let place = shadow_place_directional(view, position);
    let normal_light = shadow_light_from_render(view, normal);
    return shadow_plane_directional(view, view.mapping, place, normal_light);
}

// Returns the receiver at `position` in a view of a local light, with the gradient of its tangent
// plane. Position and normal are in render space.
fn shadow_receiver_plane_local(
    view: ShadowViewUniform,
    position: vec3<f32>,
    normal: vec3<f32>,
) -> ShadowReceiver {
    let place = shadow_place_local(view, position);
    let normal_light = shadow_light_from_render(view, normal);
    return shadow_plane_local(view, view.mapping, place, normal_light);
}

// Returns the receiver at a place of a directional light with a normal along the axes of light
// space.
//
// The plane through the receiver has the height z = -(nx x + ny y) / nz toward the light; depths
// are heights times `depth_scale`. The receiver is moved along its normal, across the map as well.
fn shadow_plane_directional(
    view: ShadowViewUniform,
    mapping: ShadowMapping,
    place: ShadowPlace,
    normal_light: vec3<f32>,
) -> ShadowReceiver {
    // Is the rise of the plane per texel, times nz.
    let rise = normal_light.xy * mapping.texel_size;
    let offset = view.offset_texels * (abs(rise.x) + abs(rise.y)) + mapping.rounding;
    // A plane that is seen edge-on has no gradient, nor does one whose normal is zero.
    let per_rise = select(0.0, -mapping.depth_scale / normal_light.z, abs(normal_light.z) > 0.0);
    let gradient = shadow_limited_gradient(rise * per_rise);
    let texel = place.texel_from_middle + normal_light.xy * offset * mapping.texel_scale;
    let depth = place.depth + mapping.depth_scale * (normal_light.z * offset);
    let raised = depth + shadow_slack(view, gradient);
    return shadow_receiver(view, mapping, place, texel, raised, gradient);
}

// Returns the receiver at a place of a local light with a normal along the axes of light space.
fn shadow_plane_local(
    view: ShadowViewUniform,
    mapping: ShadowMapping,
    place: ShadowPlace,
    normal_light: vec3<f32>,
) -> ShadowReceiver {
    let height = dot(normal_light, place.position_light);
    let rounding = shadow_local_rounding(view, place, height);
    let across = abs(normal_light.xy) * mapping.texel_size;
    let wanted = view.offset_texels * -place.position_light.z * (across.x + across.y);
    // The offset never reaches past the light: under the widest cones a texel is larger than the
    // light's height above the surface.
    let offset = min(wanted, 0.5 * (abs(height) - rounding));
    let plane = shadow_raised_plane(mapping, place, normal_light, height, rounding, offset);
    let texel = place.texel_from_middle + plane.shift;
    let gradient = shadow_limited_gradient(plane.gradient);
    let depth = plane.depth + shadow_slack(view, gradient);
    return shadow_receiver(view, mapping, place, texel, depth, gradient);
}

// Returns the depth by which the plane's own depths are raised, for rounding.
fn shadow_slack(view: ShadowViewUniform, gradient: vec2<f32>) -> f32 {
    return view.lateral_error * (abs(gradient.x) + abs(gradient.y)) + view.depth_error;
}

// Returns a gradient whose components are finite.
fn shadow_limited_gradient(gradient: vec2<f32>) -> vec2<f32> {
    return clamp(gradient, vec2<f32>(-SHADOW_MAX_GRADIENT), vec2<f32>(SHADOW_MAX_GRADIENT));
}
