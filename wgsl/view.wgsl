// Describes one depth render of a light to the shader that samples it, and the position of a
// receiver in it.
//
// Spaces: positions and normals are in render space. Light space has its axes right and down across
// the map and toward the light, and its origin at the view's anchor. Texel coordinates have their
// origin at the top left and texel centres at halves. Depth is ndc, reversed (near 1, far 0, empty
// map 0).
//
// CPU counterparts: src/receive/uniforms.rs (layout), src/receive/reference (arithmetic in f64).

// Maps the plane of a light's map to texels, and distances to depths. The plane's coordinates are
// world units in light space for a directional light, and tangents of angles for a local one.
// Shaders choose among the mappings of a light by an index that varies, so it holds no more than
// they need then.
struct ShadowMapping {
    // texel = plane * texel_scale + texel_offset, counted from the middle.
    texel_scale: vec2<f32>,
    // Is the size of a texel in units of the plane.
    texel_size: vec2<f32>,
    // For a directional light it is the ndc depth of a world unit; for a local one the world
    // distance of the near plane, since its ndc depth is that distance over the distance along the
    // axis.
    depth_scale: f32,
    // For a directional light it is the world distance along the normal by which a receiver is
    // moved for the rounding of render coordinates; for a local one the rounding error of a
    // comparison in relation to the depth.
    rounding: f32,
    // Is the middle of the part of the map in which positions have shadows, in texel coordinates. A
    // lookup needs no more than the members up to here once it has found its view.
    middle: vec2<f32>,
    // Is 1e30 where nothing casts into the view, which then covers no position.
    texel_offset: vec2<f32>,
    // Is the distance from the middle, in texels along x and y, within which a lookup stays inside
    // the view's part of the map, with kernel and bias included, and positions have shadows.
    inner: vec2<f32>,
}

struct ShadowViewUniform {
    mapping: ShadowMapping,
    // Are unit vectors of render space: right and down across the map, and toward the light along
    // the view's axis.
    right: vec3<f32>,
    // Is the ndc depth of the anchor for a directional light; 0 for a local one.
    depth_offset: f32,
    down: vec3<f32>,
    // Is the layer of the map.
    layer: u32,
    toward: vec3<f32>,
    // Is 1 for a local light, which is at the anchor, and 0 for a directional one.
    is_local: f32,
    // Is a point of render space: the position of a local light; for a directional one a point in
    // its first view.
    anchor: vec3<f32>,
    // Is the position of the first texel in a grid that is fixed in the world, modulo 65536: x in
    // the low 16 bits, y in the high 16 bits.
    grid: u32,
    // Is the number of texels per side of the layer, and its reciprocal.
    map_size: f32,
    uv_per_texel: f32,
    // Are the rounding errors of a comparison: in ndc depth, and across the map in texels.
    depth_error: f32,
    lateral_error: f32,
    // Is the offset along the normal, in texels times |nx| + |ny| of the normal in light space.
    offset_texels: f32,
    // Is the world distance toward a local light by which a receiver is moved for the rounding of
    // render coordinates, for what is the same for all receivers; `SHADOW_POSITION_ROUNDING` adds
    // what grows with the distance from the light. It is 0 for a directional light, whose mappings
    // hold it.
    offset_world: f32,
    // Are the parameters of the manual bias, in world units.
    manual_constant: f32,
    manual_slope: f32,
    // Turns the weighted sum of a kernel's comparisons into visibility: factor and summand. It
    // holds the reciprocal of the kernel's weight and the edge sharpness.
    ramp: vec2<f32>,
    // Is the world distance from the anchor beyond which a local light does not shine, and its
    // square.
    range: f32,
    range_squared: f32,
    // Is the square of the tangent of the half-angle of the cone around the view's axis; 3e38 if
    // there is no cone.
    cone_tangent_squared: f32,
    // Is the radius in world units of the direction-space filters.
    sample_radius: f32,
    // Is the tangent of half the angular diameter of a directional light, or the radius of a local
    // one in world units.
    light_spread: f32,
    // Is the reciprocal of the distance from the border, in texels, within which a cascade blends
    // into the next one.
    blend_scale: f32,
    // Is the position of the first camera in render space. w is 1, or 0 where the frame has no
    // camera.
    camera: vec4<f32>,
    // Determines where shadows end, by a weight that is at least one where shadows are complete and
    // at most zero where they have ended. For a directional light it is a plane whose product with
    // a position is the weight. For a local light the weight is w minus x times the distance from
    // the light.
    limit: vec4<f32>,
}

struct ShadowReceiver {
    // Is the position in texel coordinates.
    texel: vec2<f32>,
    // Is the reference depth at `texel`, moved toward the light by the bias.
    depth: f32,
    // Is the change of the reference depth per texel along x and y: that of the receiver's tangent
    // plane, or zero.
    gradient: vec2<f32>,
    layer: u32,
    uv_per_texel: f32,
    ramp: vec2<f32>,
    // Is the radius of a penumbra in texels per difference of depth.
    penumbra: vec2<f32>,
    // Is the position of the map's first texel in a grid that is fixed in the world.
    grid: u32,
    // Tells whether the view covers the receiver's position. Where it is false, the lookup has no
    // meaning and the position is lit.
    inside: bool,
}

// Returns a vector of render space along the axes of light space.
fn shadow_light_from_render(view: ShadowViewUniform, vector: vec3<f32>) -> vec3<f32> {
    return vec3<f32>(dot(vector, view.right), dot(vector, view.down), dot(vector, view.toward));
}

// Returns `visibility` faded to light toward the end of a directional light's shadows.
fn shadow_limited_by_depth(view: ShadowViewUniform, position: vec3<f32>, visibility: f32) -> f32 {
    return shadow_faded(shadow_weight_by_depth(view, position), visibility);
}

// Returns `visibility` faded to light toward the end of a local light's range.
fn shadow_limited_by_distance(
    view: ShadowViewUniform,
    position: vec3<f32>,
    visibility: f32,
) -> f32 {
    return shadow_faded(shadow_weight_by_distance(view, position), visibility);
}

// Returns the weight by which a directional light's shadows fade. A lookup takes it first, so that
// it does not hold the position in registers any longer.
fn shadow_weight_by_depth(view: ShadowViewUniform, position: vec3<f32>) -> f32 {
    return dot(position, view.limit.xyz) + view.limit.w;
}

// Returns the weight by which a local light's shadows fade.
fn shadow_weight_by_distance(view: ShadowViewUniform, position: vec3<f32>) -> f32 {
    return view.limit.w - view.limit.x * length(position - view.anchor);
}

// Returns `visibility` where the weight is one or more, 1 where it is zero or less, and the
// interpolation in between.
fn shadow_faded(weight: f32, visibility: f32) -> f32 {
    return 1.0 + clamp(weight, 0.0, 1.0) * (visibility - 1.0);
}

// Are the same for lights whose shadows do not fade.
fn shadow_not_weighted(view: ShadowViewUniform, position: vec3<f32>) -> f32 {
    return 1.0;
}
fn shadow_not_faded(weight: f32, visibility: f32) -> f32 {
    return visibility;
}
