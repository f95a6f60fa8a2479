// One depth render of a light as a receiver sees it, and where a receiver stands in it.
//
// Spaces: positions and normals are render space; texels have their origin top left and centres at halves; depth is ndc,
// reversed (near 1, far 0, empty map 0).
// Rust twins: src/receive/uniforms.rs (layout), src/receive/reference.rs (arithmetic in f64).

struct ShadowView {
    // Homogeneous texel x, texel y, depth and w from coordinates relative to the anchor.
    texel_from_anchor: mat4x4<f32>,
    // Rows of the inverse transpose: they take a plane (normal, -normal · point) to texel space.
    plane_across: vec4<f32>,
    plane_down: vec4<f32>,
    plane_depth: vec4<f32>,
    // Toward the light along the view's axis; w = 1 for a local light, whose place is the anchor, 0 for a directional one.
    light: vec4<f32>,
    // A point of render space inside the view.
    anchor: vec3<f32>,
    layer: u32,
    // Texels between which a lookup stays inside the map, kernel and bias included: x and y from, x and y to. Empty (from > to)
    // where nothing casts.
    inner: vec4<f32>,
    map_size: f32,
    // Rounding error of a comparison: absolute in ndc depth, relative to the depth, and across the map in texels.
    depth_error: f32,
    depth_error_relative: f32,
    lateral_error: f32,
    // Offset along the normal in texels times |nx| + |ny| of the normal in light space.
    offset_texels: f32,
    // Distance in world units by which a receiver's plane is moved, for the rounding of render coordinates. Of a local light only
    // what is the same for all receivers: shadow_clear_of_rounding adds what grows with the distance from it.
    offset_world: f32,
    // Manual bias in world units.
    manual_constant: f32,
    manual_slope: f32,
    // Edge sharpness of gathered filters; 1 is plain.
    sharpness: f32,
    // World distance from the anchor beyond which a local light does not shine.
    range: f32,
    // Cosine of the half-angle of a cone around the view's axis; -2 for none.
    cone_cosine: f32,
    // Radius in world units of the direction-space filters.
    sample_radius: f32,
    // The viewer in render space; w = 0 where no viewer is known.
    viewer: vec4<f32>,
    // Texels along x and y over which a light with size spreads a penumbra, per difference of ndc depth.
    penumbra: vec2<f32>,
    // Texels from the border within which a cascade gives way to the next.
    fade_texels: f32,
    // Where the first texel lies in a grid that is fixed in the world, modulo 65536: x in the low half, y in the high.
    grid: u32,
}

struct ShadowReceiver {
    texel: vec2<f32>,
    // Reference depth at `texel`, moved toward the light by the bias.
    depth: f32,
    // Change of the reference depth per texel along x and y: the receiver's own plane, or zero.
    gradient: vec2<f32>,
    layer: u32,
    map_size: f32,
    sharpness: f32,
    // Radius of a penumbra in texels per difference of depth.
    penumbra: vec2<f32>,
    // The map's first texel in a grid that is fixed in the world.
    grid: u32,
    // `shadow_view_holds` of the place: where it is false, the lookup means nothing and the place is lit.
    inside: bool,
}

// Does the map say anything of a place in render space: inside its sides, not beyond its far plane, in front of a local light
// and within its cone and range? Where it does not, the place is lit.
fn shadow_view_holds(view: ShadowView, position: vec3<f32>) -> bool {
    let relative = position - view.anchor;
    let distance_squared = dot(relative, relative);
    // The cone stands before the range for the sake of Mesa's software Vulkan driver (seen in 22.3, which Debian 12 has). It
    // looks for branches that depend on uniforms alone, and notes each member of a uniform buffer that it meets in a condition
    // before the first value that varies; for the fourth buffer of a stage and those after it, it writes the note past the end
    // of its table, and crashes. Of the cone it meets the place first, of `a <= b` the right side. The biases select instead of
    // branching for the same reason.
    let reached = -dot(relative, view.light.xyz) >= view.cone_cosine * sqrt(distance_squared)
        && distance_squared <= view.range * view.range;
    return reached && shadow_view_covers(view, position);
}

// The same of a directional light, which has neither cone nor range.
fn shadow_view_covers(view: ShadowView, position: vec3<f32>) -> bool {
    let place = view.texel_from_anchor * vec4<f32>(position - view.anchor, 1.0);
    let texel = place.xy / place.w;
    let within = all(texel >= view.inner.xy) && all(texel <= view.inner.zw);
    return within && place.w > 0.0 && place.z >= 0.0;
}

// Weight of a cascade at a place that it holds, where cascades blend: one, and less in the last texels before its border. Never
// zero, so that a place in one cascade alone has a weighted mean.
fn shadow_view_weight(view: ShadowView, position: vec3<f32>) -> f32 {
    let place = view.texel_from_anchor * vec4<f32>(position - view.anchor, 1.0);
    let texel = place.xy / place.w;
    let from_border = min(texel - view.inner.xy, view.inner.zw - texel);
    return clamp(min(from_border.x, from_border.y) / view.fade_texels, 1.0 / 4096.0, 1.0);
}

// The receiver of a place in render space that the bias has moved to `moved`, relative to the anchor, with `depth_offset`
// toward the light.
fn shadow_receiver_at(
    view: ShadowView,
    position: vec3<f32>,
    moved: vec3<f32>,
    gradient: vec2<f32>,
    depth_offset: f32,
) -> ShadowReceiver {
    let place = view.texel_from_anchor * vec4<f32>(moved, 1.0);
    let depth = place.z / place.w;
    var receiver: ShadowReceiver;
    receiver.texel = place.xy / place.w;
    let on_map = all(receiver.texel >= vec2<f32>(0.0)) && all(receiver.texel <= vec2<f32>(view.map_size));
    // Moved past a local light or off the map, as an offset along the normal may under the widest cones: lit, by a depth that
    // is nearer than any map's.
    let kept = place.w > 0.0 && on_map;
    receiver.depth = select(2.0, depth + depth_offset + depth * view.depth_error_relative, kept);
    receiver.gradient = gradient;
    receiver.layer = view.layer;
    receiver.map_size = view.map_size;
    receiver.sharpness = view.sharpness;
    receiver.penumbra = view.penumbra;
    receiver.grid = view.grid;
    receiver.inside = shadow_view_holds(view, position);
    return receiver;
}

// The receiver's tangent plane in texel space: its components along texel x, texel y and depth.
fn shadow_plane(view: ShadowView, relative: vec3<f32>, normal: vec3<f32>) -> vec3<f32> {
    let plane = vec4<f32>(normal, -dot(normal, relative));
    return vec3<f32>(
        dot(view.plane_across, plane),
        dot(view.plane_down, plane),
        dot(view.plane_depth, plane),
    );
}

// World distance along the normal by which `texels` of the map displace a plane at this place: texels * s * (|nx| + |ny|) with
// s the world size of a texel and n the normal in light space.
fn shadow_normal_offset(
    view: ShadowView,
    relative: vec3<f32>,
    plane: vec3<f32>,
    texels: f32,
) -> f32 {
    let w = dot(shadow_w_row(view), vec4<f32>(relative, 1.0));
    return texels * max(w, 0.0) * (abs(plane.x) + abs(plane.y));
}

// Is the rounding of a render coordinate of a caster or a receiver, relative to the coordinate: 4u, with u = 2^-24.
const SHADOW_POSITION_ROUNDING: f32 = 2.3841858e-7;

// Returns a position around a local light, moved toward the light so far that its tangent plane rises by all that rounding
// may displace it. The position stays on its texel, since an offset along the normal could lead off the map. Everything that a
// receiver is compared with is no farther from the light than the receiver, so the rounding grows with the receiver's own
// distance. Under a directional light the position is returned unchanged.
fn shadow_clear_of_rounding(view: ShadowView, relative: vec3<f32>, normal: vec3<f32>) -> vec3<f32> {
    let apart = abs(relative);
    let farthest = max(max(apart.x, apart.y), apart.z);
    let rounding = view.offset_world + SHADOW_POSITION_ROUNDING * farthest;
    // Where the light is next to the plane, the receiver moves by half of its way to the light.
    let share = rounding / max(shadow_light_height(view, relative, normal), 2.0 * rounding);
    return relative * (1.0 - select(0.0, share, view.light.w > 0.0));
}

// Returns the world distance along the normal that allows for the rounding of render coordinates under a directional light; 0
// for a local light, which shadow_clear_of_rounding serves.
fn shadow_rounding_offset(view: ShadowView) -> f32 {
    return select(view.offset_world, 0.0, view.light.w > 0.0);
}

// World distance of the light from a place's tangent plane; endless for a directional light.
fn shadow_light_height(view: ShadowView, relative: vec3<f32>, normal: vec3<f32>) -> f32 {
    return select(1e30, abs(dot(normal, relative)), view.light.w > 0.0);
}

// What w is made of: one for an orthographic view, the distance along the axis for a perspective one.
fn shadow_w_row(view: ShadowView) -> vec4<f32> {
    let columns = view.texel_from_anchor;
    return vec4<f32>(columns[0].w, columns[1].w, columns[2].w, columns[3].w);
}
