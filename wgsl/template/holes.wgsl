// Declares the holes of the templates in this folder, so that the templates are valid WGSL as they
// stand, for editors and for the tests. Nothing in this file is ever emitted.
//
// A hole is the part of an identifier that is in capitals, such as NAME in `shadow_views_NAME`. The
// library's own constants, which begin with SHADOW_, have no holes, and comments have none either.
// Where a hole is filled with nothing, the rest of its list item is removed as well, up to and
// including the comma. Two holes are declared by the templates themselves: NAME, which is the name
// of a light, and SAMPLER, which is the name of a sampler. Requires: view, place, cube_face,
// filter_direction, error_meter.

// Is the number of the bind group, with the suffix `u`.
const GROUP: u32 = 1u;

// Is the number of a sampler's binding, without suffix.
const SAMPLER_BINDING: u32 = 0u;

// Is the type of a sampler: `sampler` or `sampler_comparison`.
alias SAMPLER_TYPE = sampler;

// Is the number of the binding of a light's uniforms, without suffix.
const VIEWS_BINDING: u32 = 1u;

// Is the number of the binding of a light's map, without suffix.
const MAP_BINDING: u32 = 2u;

// Is the type of a light's map: `texture_depth_2d_array`, or `texture_2d_array<f32>` where shaders
// cannot gather.
alias MAP_TYPE = texture_depth_2d_array;

// Is the number of all views of a light or a pool, without suffix, as the length of an array.
const ARRAY_LENGTH: u32 = 6u;

// Is the number of all views with the suffix `u`, which `shadow_view_NAME` also returns where no
// view covers a position.
const VIEW_COUNT: u32 = 6u;

// Is the parameter `index` of a pool's functions, which is the index of a slot. It is filled with
// nothing for a single light.
const INDEX: u32 = 0u;

// Is the first view of the light: `0u`, or for a pool an expression of `index`. For an index that
// no slot has, it is VIEW_COUNT.
const FIRST_VIEW: u32 = 0u;

// Is a view of the light, for reading what all its views have in common. It is FIRST_VIEW, or a
// view of another light for an index that no slot has, so that it is always below VIEW_COUNT.
const ANY_VIEW: u32 = 0u;

// Is the view of the light of which the size counts: ANY_VIEW where all faces have the same, and
// `view`, which is the view of the face, where each has its own.
const INNER_VIEW: u32 = 0u;

// Are the numbers of a cascade and of the next one, without suffix. In `cascades.wgsl` CASCADE is
// the first one.
const CASCADE: u32 = 0u;
const NEXT: u32 = 1u;

// Is the layer of the map that a lookup reads: `place.layer`, or `0u` where all views of the light
// share a layer.
const LAYER: u32 = 0u;

// BIAS is the bias for the kind of light: `plane_directional`, `normal_offset_local` and so on.
fn shadow_BIAS(
    view: ShadowViewUniform,
    mapping: ShadowMapping,
    place: ShadowPlace,
    normal_light: vec3<f32>,
) -> ShadowReceiver {
    return shadow_receiver(view, mapping, place, place.texel_from_middle, place.depth, vec2<f32>(0.0));
}

// FILTER is the name of the filter's module, such as `filter_tent3`.
fn shadow_FILTER(map: MAP_TYPE, map_sampler: SAMPLER_TYPE, receiver: ShadowReceiver) -> f32 {
    return 1.0;
}

// WEIGHT is what ends the light's shadows: `weight_by_depth`, `weight_by_distance` or
// `not_weighted`. FADED is how: `faded` or `not_faded`.
fn shadow_WEIGHT(view: ShadowViewUniform, position: vec3<f32>) -> f32 {
    return 1.0;
}
fn shadow_FADED(weight: f32, visibility: f32) -> f32 {
    return visibility;
}

// PATTERN is the pattern of the directions around that of the receiver: `grid` or `star`.
fn shadow_direction_PATTERN(index: u32) -> vec3<f32> {
    return shadow_direction_grid(index);
}
fn shadow_direction_PATTERN_radius(view: ShadowViewUniform, position: vec3<f32>) -> f32 {
    return shadow_direction_grid_radius(view, position);
}

// Is the number of those directions, as a u32 and as an f32.
const SAMPLE_COUNT: u32 = 64u;
const SAMPLE_COUNT_F32: f32 = 64.0;

// SURFACE is the surface that the sample in a direction lies on, and NORMAL is the normal if that
// surface needs one: `plane` and `normal`, or `sphere` and nothing.
fn shadow_direction_on_SURFACE(
    from_light: vec3<f32>,
    normal: vec3<f32>,
    offset: vec3<f32>,
) -> vec3<f32> {
    return shadow_direction_on_plane(from_light, normal, offset);
}
const NORMAL: vec3<f32> = vec3<f32>(0.0, 1.0, 0.0);
