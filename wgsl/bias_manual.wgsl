// Applies the manual bias of the tutorial at learnopengl.com: max(slope * (1 - n · l), constant),
// in world units toward the light.
//
// CPU reference: src/receive/reference. Requires: view, place.

// Returns the receiver at `position` in a view of a directional light, moved toward the light by
// the manual bias. Position and normal are in render space.
fn shadow_receiver_manual_directional(
    view: ShadowViewUniform,
    position: vec3<f32>,
    normal: vec3<f32>,
) -> ShadowReceiver {
    let place = shadow_place_directional(view, position);
    let normal_light = shadow_light_from_render(view, normal);
    return shadow_manual_directional(view, view.mapping, place, normal_light);
}

// Returns the receiver at `position` in a view of a local light, moved toward the light by the
// manual bias. Position and normal are in render space.
fn shadow_receiver_manual_local(
    view: ShadowViewUniform,
    position: vec3<f32>,
    normal: vec3<f32>,
) -> ShadowReceiver {
    let place = shadow_place_local(view, position);
    let normal_light = shadow_light_from_render(view, normal);
    return shadow_manual_local(view, view.mapping, place, normal_light);
}

// Returns the receiver at a place of a directional light with a normal along the axes of light
// space.
fn shadow_manual_directional(
    view: ShadowViewUniform,
    mapping: ShadowMapping,
    place: ShadowPlace,
    normal_light: vec3<f32>,
) -> ShadowReceiver {
    let toward = max(view.manual_slope * (1.0 - normal_light.z), view.manual_constant);
    let depth = place.depth + mapping.depth_scale * toward;
    return shadow_receiver(view, mapping, place, place.texel_from_middle, depth, vec2<f32>(0.0));
}

// Returns the receiver at a place of a local light with a normal along the axes of light space. A
// receiver that the bias moves past the light is lit: its depth is set nearer than any in the map.
fn shadow_manual_local(
    view: ShadowViewUniform,
    mapping: ShadowMapping,
    place: ShadowPlace,
    normal_light: vec3<f32>,
) -> ShadowReceiver {
    let per_distance = inverseSqrt(dot(place.position_light, place.position_light));
    let facing = -dot(normal_light, place.position_light) * per_distance;
    let toward = max(view.manual_slope * (1.0 - facing), view.manual_constant);
    let left = 1.0 - toward * per_distance;
    let depth = select(2.0, place.depth / left, left > 0.0);
    return shadow_receiver(view, mapping, place, place.texel_from_middle, depth, vec2<f32>(0.0));
}
