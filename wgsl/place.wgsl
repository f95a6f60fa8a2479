// Finds where a position falls in a view's map, and whether the view covers it.
//
// All views of a directional light have the same axes and the same anchor, so a position is
// transformed to light space once, and a scale and an offset lead from there to each map. A local
// light has one such transform for each view; for the faces of a cube it only exchanges coordinates
// (`cube_face`).
//
// A view covers a position that is within the sides of its map, not beyond its far plane, in front
// of a local light, and within that light's cone and range. A position that no view covers is lit.
// Every comparison is false for NaN.
//
// In all comparisons with a uniform, the value that varies is the first operand of `<`, because of
// a defect in Mesa's software Vulkan driver (seen in 22.3, which is that of Debian 12). The driver
// looks for branches that depend on uniforms alone, and records each member of a uniform buffer
// that it finds in a condition before the first value that varies. For the fourth and later buffers
// of a stage it writes that record past the end of its table, and crashes. It takes the first
// operand first, and for `<=` and `>` the second one, and looks through the arithmetic that makes
// an operand in the same order, so the vector that varies is also the first one of every `dot`. For
// the same reason the biases use `select` instead of branches, and no comparison is joined by an
// operator that may branch.
//
// CPU reference: src/receive/reference. Requires: view.

struct ShadowPlace {
    // Is the position relative to the anchor along the axes of light space, in world units.
    position_light: vec3<f32>,
    // Is the position in texels from the middle.
    texel_from_middle: vec2<f32>,
    // Is the ndc depth.
    depth: f32,
    // Is the reciprocal of the world distance along the axis of a local light; 1 for a directional
    // one.
    inverse_w: f32,
    // Is the number of the view, which is also that of its layer unless views share a layer.
    layer: u32,
    // Is the position of the map's first texel in a grid that is fixed in the world.
    grid: u32,
    // Tells whether the view covers the position.
    inside: bool,
}

// Returns where a position of light space falls in a view of a directional light.
fn shadow_directional_place(
    view: ShadowViewUniform,
    layer: u32,
    position_light: vec3<f32>,
) -> ShadowPlace {
    let texel = position_light.xy * view.mapping.texel_scale + view.mapping.texel_offset;
    let depth = position_light.z * view.mapping.depth_scale + view.depth_offset;
    let inside = all(abs(texel) < view.mapping.inner) & (depth >= 0.0);
    return ShadowPlace(position_light, texel, depth, 1.0, layer, view.grid, inside);
}

// Returns `first` where its view covers the position, and otherwise `second`. Both are places of
// one position in views of one directional light.
fn shadow_first_place(first: ShadowPlace, second: ShadowPlace) -> ShadowPlace {
    return ShadowPlace(
        first.position_light,
        select(second.texel_from_middle, first.texel_from_middle, first.inside),
        select(second.depth, first.depth, first.inside),
        1.0,
        select(second.layer, first.layer, first.inside),
        select(second.grid, first.grid, first.inside),
        first.inside | second.inside,
    );
}

// Returns where a position of light space falls in a view of a local light, whose cone is left to
// `shadow_in_cone`.
fn shadow_local_place(
    view: ShadowViewUniform,
    mapping: ShadowMapping,
    layer: u32,
    grid: u32,
    position_light: vec3<f32>,
) -> ShadowPlace {
    let inverse_w = -1.0 / position_light.z;
    let texel = position_light.xy * inverse_w * mapping.texel_scale + mapping.texel_offset;
    let depth = mapping.depth_scale * inverse_w;
    let distance_squared = dot(position_light, position_light);
    let inside = all(abs(texel) < view.mapping.inner)
        & (position_light.z < 0.0)
        & (distance_squared < view.range_squared);
    return ShadowPlace(position_light, texel, depth, inverse_w, layer, grid, inside);
}

// Returns whether a place is within the cone of its light.
fn shadow_in_cone(view: ShadowViewUniform, place: ShadowPlace) -> bool {
    let tangent = place.position_light.xy * place.inverse_w;
    return dot(tangent, tangent) < view.cone_tangent_squared;
}

// Returns where a position of render space falls in one view of a directional light.
fn shadow_place_directional(view: ShadowViewUniform, position: vec3<f32>) -> ShadowPlace {
    let position_light = shadow_light_from_render(view, position - view.anchor);
    return shadow_directional_place(view, view.layer, position_light);
}

// Returns where a position of render space falls in one view of a local light.
fn shadow_place_local(view: ShadowViewUniform, position: vec3<f32>) -> ShadowPlace {
    let position_light = shadow_light_from_render(view, position - view.anchor);
    var place = shadow_local_place(view, view.mapping, view.layer, view.grid, position_light);
    place.inside = place.inside & shadow_in_cone(view, place);
    return place;
}

// Returns whether a view of any light covers a position of render space.
fn shadow_view_holds(view: ShadowViewUniform, position: vec3<f32>) -> bool {
    let is_local = view.is_local > 0.0;
    return select(
        shadow_place_directional(view, position).inside,
        shadow_place_local(view, position).inside,
        is_local,
    );
}

// Returns the weight of a cascade at a place that it covers, where cascades blend: one, and less in
// the last texels before its border. It is never zero, so that a position in one cascade alone has
// a weighted mean.
fn shadow_blend_weight(view: ShadowViewUniform, place: ShadowPlace) -> f32 {
    let from_border = view.mapping.inner - abs(place.texel_from_middle);
    return clamp(min(from_border.x, from_border.y) * view.blend_scale, 1.0 / 4096.0, 1.0);
}

// Returns the receiver of a bias: `texel_from_middle` in texels from the middle, `depth` in ndc
// with the bias included.
fn shadow_receiver(
    view: ShadowViewUniform,
    mapping: ShadowMapping,
    place: ShadowPlace,
    texel_from_middle: vec2<f32>,
    depth: f32,
    gradient: vec2<f32>,
) -> ShadowReceiver {
    var receiver: ShadowReceiver;
    receiver.texel = texel_from_middle + mapping.middle;
    receiver.depth = depth;
    receiver.gradient = gradient;
    receiver.layer = place.layer;
    receiver.uv_per_texel = view.uv_per_texel;
    receiver.ramp = view.ramp;
    receiver.penumbra = view.light_spread / mapping.depth_scale * mapping.texel_scale;
    receiver.grid = place.grid;
    receiver.inside = place.inside;
    return receiver;
}
