// Describes one depth render of a light to the shader that samples it, and the position of a receiver in it.
//
// Spaces: positions and normals are in render space. Texel coordinates have their origin at the top left and texel
// centres at halves. Depth is ndc, reversed (near 1, far 0, empty map 0).
//
// CPU counterparts: src/receive/uniforms.rs (layout), src/receive/reference.rs (arithmetic in f64).

struct ShadowViewUniform {
    // Transforms coordinates relative to the anchor to homogeneous texel x, texel y, ndc depth and w.
    texel_from_anchor: mat4x4<f32>,
    // Are rows of the inverse transpose, which transform a plane (normal, -normal · point) to texel space.
    plane_across: vec4<f32>,
    plane_down: vec4<f32>,
    plane_depth: vec4<f32>,
    // Is the unit vector toward the light along the view's axis. w is 1 for a local light, which is at the anchor, and
    // 0 for a directional one.
    light: vec4<f32>,
    // Is a point of render space inside the view; for a local light, the light's position.
    anchor: vec3<f32>,
    // Is the layer of the map.
    layer: u32,
    // Bounds the texel coordinates at which a lookup stays inside the map, with kernel and bias included: least x,
    // least y, greatest x, greatest y. The least ones exceed the greatest ones where nothing casts into the view.
    inner: vec4<f32>,
    // Is the number of texels per side of the map.
    map_size: f32,
    // Are the rounding errors of a comparison: absolute in ndc depth, in relation to the depth, and across the map in
    // texels.
    depth_error: f32,
    depth_error_relative: f32,
    lateral_error: f32,
    // Is the offset along the normal, in texels times |nx| + |ny| of the normal in light space.
    offset_texels: f32,
    // Distance in world units by which a receiver's plane is moved, for the rounding of render coordinates. Of a local light only
    // what is the same for all receivers: shadow_clear_of_rounding adds what grows with the distance from it.
    offset_world: f32,
    // Are the parameters of the manual bias, in world units.
    manual_constant: f32,
    manual_slope: f32,
    // Is the edge sharpness of gathered filters; 1 leaves their ramp as it is.
    sharpness: f32,
    // World distance from the anchor beyond which a local light does not shine.
    range: f32,
    // Is the cosine of the half-angle of the cone around the view's axis; -2 if there is no cone.
    cone_cosine: f32,
    // Is the radius in world units of the direction-space filters.
    sample_radius: f32,
    // Is the position of the first camera in render space. w is 1, or 0 where the frame has no camera.
    camera: vec4<f32>,
    // Is the radius of a penumbra in texels along x and y, per difference of ndc depth.
    penumbra: vec2<f32>,
    // Is the distance from the border, in texels, within which a cascade blends into the next one.
    fade_texels: f32,
    // Is the position of the first texel in a grid that is fixed in the world, modulo 65536: x in the low 16 bits, y in
    // the high 16 bits.
    grid: u32,
    // Determines where shadows end, by a weight that is at least one where shadows are complete and at most zero where
    // they have ended. For a directional light it is a plane whose product with a position is the weight. For a local
    // light the weight is w minus x times the distance from the light.
    limit: vec4<f32>,
}

struct ShadowReceiver {
    // Is the position in texel coordinates.
    texel: vec2<f32>,
    // Is the reference depth at `texel`, moved toward the light by the bias.
    depth: f32,
    // Is the change of the reference depth per texel along x and y: that of the receiver's tangent plane, or zero.
    gradient: vec2<f32>,
    layer: u32,
    map_size: f32,
    sharpness: f32,
    // Is the radius of a penumbra in texels per difference of depth.
    penumbra: vec2<f32>,
    // Is the position of the map's first texel in a grid that is fixed in the world.
    grid: u32,
    // Is the result of `shadow_view_holds` for the receiver's position. Where it is false, the lookup has no meaning
    // and the position is lit.
    inside: bool,
}

// Returns whether the map covers a position in render space: within its sides, not beyond its far plane, in front of a
// local light, and within the light's cone and range. A position that no view covers is lit.
fn shadow_view_holds(view: ShadowViewUniform, position: vec3<f32>) -> bool {
    let relative = position - view.anchor;
    let distance_squared = dot(relative, relative);
    // The cone is tested before the range because of a defect in Mesa's software Vulkan driver (seen in 22.3, which is
    // that of Debian 12). The driver looks for branches that depend on uniforms alone, and records each member of a
    // uniform buffer that it finds in a condition before the first value that varies. For the fourth and later buffers
    // of a stage it writes that record past the end of its table, and crashes. In the test of the cone it finds the
    // position first, as the left side of `>=`; in a test with `<=`, such as that of the range, it finds the right side
    // first. For the same reason the biases use `select` instead of branches.
    let reached = -dot(relative, view.light.xyz) >= view.cone_cosine * sqrt(distance_squared)
        && distance_squared <= view.range * view.range;
    return reached && shadow_view_covers(view, position);
}

// Returns whether the map covers a position in render space, for a directional light, which has neither cone nor range.
fn shadow_view_covers(view: ShadowViewUniform, position: vec3<f32>) -> bool {
    let homogeneous = view.texel_from_anchor * vec4<f32>(position - view.anchor, 1.0);
    let texel = homogeneous.xy / homogeneous.w;
    let within = all(texel >= view.inner.xy) && all(texel <= view.inner.zw);
    return within && homogeneous.w > 0.0 && homogeneous.z >= 0.0;
}

// Returns the weight of a cascade at a position that it covers, where cascades blend: one, and less in the last texels
// before its border. It is never zero, so that a position in one cascade alone has a weighted mean.
fn shadow_view_weight(view: ShadowViewUniform, position: vec3<f32>) -> f32 {
    let homogeneous = view.texel_from_anchor * vec4<f32>(position - view.anchor, 1.0);
    let texel = homogeneous.xy / homogeneous.w;
    let from_border = min(texel - view.inner.xy, view.inner.zw - texel);
    return clamp(min(from_border.x, from_border.y) / view.fade_texels, 1.0 / 4096.0, 1.0);
}

// Returns `visibility` faded to light toward the end of a directional light's shadows. A position with a NaN is lit.
fn shadow_limited_by_depth(view: ShadowViewUniform, position: vec3<f32>, visibility: f32) -> f32 {
    return shadow_faded(dot(view.limit.xyz, position) + view.limit.w, visibility);
}

// Returns `visibility` faded to light toward the end of a local light's range.
fn shadow_limited_by_distance(view: ShadowViewUniform, position: vec3<f32>, visibility: f32) -> f32 {
    return shadow_faded(view.limit.w - view.limit.x * length(position - view.anchor), visibility);
}

// Returns `visibility` unchanged, for lights whose shadows do not fade.
fn shadow_not_limited(view: ShadowViewUniform, position: vec3<f32>, visibility: f32) -> f32 {
    return visibility;
}

// Returns `visibility`, to the bit, where the weight is one or more, 1 where it is zero or less, and the interpolation
// in between. A weight that is NaN gives 1 as well, because both comparisons are then false.
fn shadow_faded(weight: f32, visibility: f32) -> f32 {
    let faded = 1.0 - weight * (1.0 - visibility);
    return select(select(1.0, faded, weight > 0.0), visibility, weight >= 1.0);
}

// Returns the receiver at `position` (render space), which the bias has moved to `moved` (relative to the anchor) and
// by `depth_offset` (ndc depth) toward the light.
fn shadow_receiver_at(
    view: ShadowViewUniform,
    position: vec3<f32>,
    moved: vec3<f32>,
    gradient: vec2<f32>,
    depth_offset: f32,
) -> ShadowReceiver {
    let homogeneous = view.texel_from_anchor * vec4<f32>(moved, 1.0);
    let depth = homogeneous.z / homogeneous.w;
    var receiver: ShadowReceiver;
    receiver.texel = homogeneous.xy / homogeneous.w;
    let on_map = all(receiver.texel >= vec2<f32>(0.0)) && all(receiver.texel <= vec2<f32>(view.map_size));
    // Under the widest cones an offset along the normal may move the receiver past a local light or off the map. Such a
    // receiver is lit: its depth is set nearer than any in the map.
    let kept = homogeneous.w > 0.0 && on_map;
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

// Returns the receiver's tangent plane in texel space: its components along texel x, texel y and depth.
fn shadow_plane(view: ShadowViewUniform, relative: vec3<f32>, normal: vec3<f32>) -> vec3<f32> {
    let plane = vec4<f32>(normal, -dot(normal, relative));
    return vec3<f32>(
        dot(view.plane_across, plane),
        dot(view.plane_down, plane),
        dot(view.plane_depth, plane),
    );
}

// Returns the world distance along the normal by which `texels` of the map displace a plane at this position:
// texels * s * (|nx| + |ny|), with s the world size of a texel and n the normal in light space.
fn shadow_normal_offset(
    view: ShadowViewUniform,
    relative: vec3<f32>,
    plane: vec3<f32>,
    texels: f32,
) -> f32 {
    let w = dot(shadow_w_row(view), vec4<f32>(relative, 1.0));
    return texels * max(w, 0.0) * (abs(plane.x) + abs(plane.y));
}

// Is the rounding of a render coordinate of a caster or a receiver, relative to the coordinate: 4u, with u = 2^-24.
const SHADOW_POSITION_ROUNDING: f32 = 2.3841858e-7;

// Returns a position around a local light (relative to the anchor), moved toward the light so far that its tangent
// plane rises by all that rounding may displace it. The position stays on its texel, since an offset along the normal
// could lead off the map. Everything that a receiver is compared with is no farther from the light than the receiver,
// so the rounding grows with the receiver's own distance. Under a directional light the position is returned unchanged.
fn shadow_clear_of_rounding(view: ShadowViewUniform, relative: vec3<f32>, normal: vec3<f32>) -> vec3<f32> {
    let apart = abs(relative);
    let farthest = max(max(apart.x, apart.y), apart.z);
    let rounding = view.offset_world + SHADOW_POSITION_ROUNDING * farthest;
    // Where the light is next to the plane, the receiver moves by half of its way to the light.
    let share = rounding / max(shadow_light_height(view, relative, normal), 2.0 * rounding);
    return relative * (1.0 - select(0.0, share, view.light.w > 0.0));
}

// Returns the world distance along the normal that allows for the rounding of render coordinates under a directional
// light; 0 for a local light, which shadow_clear_of_rounding serves.
fn shadow_rounding_offset(view: ShadowViewUniform) -> f32 {
    return select(view.offset_world, 0.0, view.light.w > 0.0);
}

// Returns the world distance of the light from the tangent plane at a position; 1e30 for a directional light.
fn shadow_light_height(view: ShadowViewUniform, relative: vec3<f32>, normal: vec3<f32>) -> f32 {
    return select(1e30, abs(dot(normal, relative)), view.light.w > 0.0);
}

// Returns the row of the matrix that gives w: one for an orthographic view, the distance along the axis for a
// perspective one.
fn shadow_w_row(view: ShadowViewUniform) -> vec4<f32> {
    let columns = view.texel_from_anchor;
    return vec4<f32>(columns[0].w, columns[1].w, columns[2].w, columns[3].w);
}
