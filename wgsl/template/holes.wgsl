// Declares the holes of the templates in this folder, so that the templates are valid WGSL as they stand, for editors and for
// the tests. Nothing in this file is ever emitted.
//
// A hole is the part of an identifier that is in capitals, such as NAME in `shadow_views_NAME`. The library's own constants,
// which begin with SHADOW_, have no holes, and neither have comments. A hole that is filled with nothing takes the rest of its
// list item with it, up to and including the comma. Two holes are declared by the templates themselves: NAME, which is the name
// of a light, and SAMPLER, which is the name of a sampler.
// Requires: view, cube_face, filter_direction.

// Number of the bind group, with the suffix `u`.
const GROUP: u32 = 1u;

// Number of a sampler's binding, without suffix.
const SAMPLER_BINDING: u32 = 0u;

// Type of a sampler: `sampler` or `sampler_comparison`.
alias SAMPLER_TYPE = sampler;

// Number of the binding of a light's uniforms, without suffix.
const VIEWS_BINDING: u32 = 1u;

// Number of the binding of a light's map, without suffix.
const MAP_BINDING: u32 = 2u;

// Type of a light's map: `texture_depth_2d_array`, or `texture_2d_array<f32>` where shaders cannot gather.
alias MAP_TYPE = texture_depth_2d_array;

// Number of all views of a light or a pool, without suffix, as the length of an array.
const ARRAY_LENGTH: u32 = 6u;

// The same number with the suffix `u`, which is also what `shadow_view_NAME` returns where no view serves a position.
const VIEW_COUNT: u32 = 6u;

// The parameter `index` of a pool's functions, which is the index of a slot. It is nothing for a light that is alone.
const INDEX: u32 = 0u;

// First view of the light: `0u`, or for a pool an expression of `index`. For an index that no slot has, it is VIEW_COUNT.
const FIRST_VIEW: u32 = 0u;

// Some view of the light, for what all its views have in common: as FIRST_VIEW, but always below VIEW_COUNT.
const ANY_VIEW: u32 = 0u;

// The bias: `plane`, `normal_offset` or `manual`.
fn shadow_receiver_BIAS(view: ShadowViewUniform, position: vec3<f32>, normal: vec3<f32>) -> ShadowReceiver {
    return shadow_receiver_at(view, position, position - view.anchor, vec2<f32>(0.0), 0.0);
}

// The filter: the name of its module, such as `filter_tent3`.
fn shadow_FILTER(map: MAP_TYPE, map_sampler: SAMPLER_TYPE, receiver: ShadowReceiver) -> f32 {
    return 1.0;
}

// What ends the light's shadows: `limited_by_depth`, `limited_by_distance` or `not_limited`.
fn shadow_LIMIT(view: ShadowViewUniform, position: vec3<f32>, visibility: f32) -> f32 {
    return visibility;
}

// Directions around the receiver's own: `grid` or `star`.
fn shadow_direction_PATTERN(index: u32) -> vec3<f32> {
    return shadow_direction_grid(index);
}
fn shadow_direction_PATTERN_radius(view: ShadowViewUniform, position: vec3<f32>) -> f32 {
    return shadow_direction_grid_radius(view, position);
}

// Number of those directions, as a u32 and as an f32.
const SAMPLE_COUNT: u32 = 64u;
const SAMPLE_COUNT_F32: f32 = 64.0;

// What the sample in a direction lies on, and the normal if that matters: `plane` and `normal`, or `sphere` and nothing.
fn shadow_direction_on_SURFACE(from_light: vec3<f32>, normal: vec3<f32>, offset: vec3<f32>) -> vec3<f32> {
    return shadow_direction_on_plane(from_light, normal, offset);
}
const NORMAL: vec3<f32> = vec3<f32>(0.0, 1.0, 0.0);
