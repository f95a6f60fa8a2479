// Bias derived from the receiver's tangent plane: each texel of a kernel is compared with the plane's own depth at that texel.
//
// Ndc depth is affine in map coordinates over a plane, for orthographic and perspective views alike, so the plane needs one
// gradient. Filters clamp the extrapolated depth so that it never lies farther from the light than the receiver (Dou, Yan,
// Kerzner, Dai, Wyman 2014, "Adaptive Depth Bias for Shadow Maps"). What remains is rounding: `lateral_error` texels along the
// plane and `depth_error` in depth; and an offset of `offset_texels` for facets finer than a texel.
// Rust twin: src/receive/reference.rs. Requires: view.

// Steeper planes than this cross the whole depth range within a fraction of a texel; the limit keeps infinity out.
const SHADOW_MAX_GRADIENT: f32 = 1e4;

fn shadow_receiver_plane(view: ShadowView, position: vec3<f32>, normal: vec3<f32>) -> ShadowReceiver {
    let relative = shadow_clear_of_rounding(view, position - view.anchor, normal);
    let surface = shadow_plane(view, relative, normal);
    let wanted = shadow_normal_offset(view, relative, surface, view.offset_texels) + shadow_rounding_offset(view);
    // Never past the light: under the widest cones a texel is larger than the light's height over the surface.
    let offset = min(wanted, 0.5 * shadow_light_height(view, relative, normal));
    let lifted = relative + normal * offset;
    // The surface's plane moved by the offset: of (normal, -normal · point) only the last component changes.
    let moved = offset * dot(normal, normal);
    let plane = surface - moved * vec3<f32>(view.plane_across.w, view.plane_down.w, view.plane_depth.w);
    // A plane seen edge on has no gradient, and neither has a normal that is zero or not a number.
    let has_gradient = abs(plane.z) > 0.0;
    let limit = vec2<f32>(SHADOW_MAX_GRADIENT);
    let gradient = select(vec2<f32>(0.0), clamp(-plane.xy / plane.z, -limit, limit), has_gradient);
    let steepness = abs(gradient.x) + abs(gradient.y);
    let slack = view.lateral_error * steepness + view.depth_error;
    return shadow_receiver_at(view, position, select(relative, lifted, has_gradient), gradient, slack);
}
