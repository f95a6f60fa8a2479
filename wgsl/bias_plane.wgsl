// Derives the bias from the receiver's tangent plane: each texel of a kernel is compared with the depth of the plane at
// that texel.
//
// Over a plane, ndc depth is affine in map coordinates, for orthographic and perspective views alike, so one gradient
// describes the plane. Filters clamp the extrapolated depth so that it never lies farther from the light than the
// receiver (Dou, Yan, Kerzner, Dai, Wyman 2014, "Adaptive Depth Bias for Shadow Maps"). Two errors remain. Rounding is
// covered by `lateral_error` texels along the plane and `depth_error` in depth; facets finer than a texel are covered
// by an offset of `offset_texels` along the normal.
//
// CPU reference: src/receive/reference.rs. Requires: view.

// Is the steepest gradient, in depth per texel. Steeper planes cross the whole depth range within a fraction of a
// texel; the limit excludes infinity.
const SHADOW_MAX_GRADIENT: f32 = 1e4;

// Returns the receiver at `position` (render space) with the gradient of its tangent plane.
fn shadow_receiver_plane(view: ShadowViewUniform, position: vec3<f32>, normal: vec3<f32>) -> ShadowReceiver {
    let relative = shadow_clear_of_rounding(view, position - view.anchor, normal);
    let surface = shadow_plane(view, relative, normal);
    let wanted = shadow_normal_offset(view, relative, surface, view.offset_texels) + shadow_rounding_offset(view);
    // The offset never reaches past the light: under the widest cones a texel is larger than the light's height above
    // the surface.
    let offset = min(wanted, 0.5 * shadow_light_height(view, relative, normal));
    let lifted = relative + normal * offset;
    // This is the surface's plane moved by the offset: only the last component of (normal, -normal · point) changes.
    let moved = offset * dot(normal, normal);
    let plane = surface - moved * vec3<f32>(view.plane_across.w, view.plane_down.w, view.plane_depth.w);
    // A plane that is seen edge-on has no gradient, nor does one whose normal is zero or NaN.
    let has_gradient = abs(plane.z) > 0.0;
    let limit = vec2<f32>(SHADOW_MAX_GRADIENT);
    let gradient = select(vec2<f32>(0.0), clamp(-plane.xy / plane.z, -limit, limit), has_gradient);
    let steepness = abs(gradient.x) + abs(gradient.y);
    let slack = view.lateral_error * steepness + view.depth_error;
    return shadow_receiver_at(view, position, select(relative, lifted, has_gradient), gradient, slack);
}
