// Contains the sample patterns of the direction-space filters of point lights, which average
// nearest comparisons along directions around the receiver's own.
//
// `shadow_direction_grid` is a regular 4x4x4 grid of 64 offsets in a cube; `shadow_direction_star`
// consists of the 20 directions to the corners and edges of a cube. Each sample has the direction
// (from light to receiver) + offset and selects a face by that direction. It is compared with the
// receiver's tangent plane in that direction, clamped so that it lies no farther from the light
// than the receiver. Under a manual bias it is compared with the receiver's distance, as in the
// tutorial at learnopengl.com. CPU reference of one sample: src/receive/reference. Requires: view.

// Returns offset `index` in 0..64. Each component is one of ±1/4 and ±3/4.
fn shadow_direction_grid(index: u32) -> vec3<f32> {
    let cell = vec3<u32>(index & 3u, (index >> 2u) & 3u, index >> 4u);
    return (vec3<f32>(cell) + 0.5) / 2.0 - 1.0;
}

// Returns offset `index` in 0..20: eight corners, then four edges in each of three planes.
fn shadow_direction_star(index: u32) -> vec3<f32> {
    let signs = vec3<f32>(
        select(1.0, -1.0, (index & 1u) != 0u),
        select(1.0, -1.0, (index & 2u) != 0u),
        select(1.0, -1.0, (index & 4u) != 0u),
    );
    if index < 8u {
        return signs;
    }
    switch (index - 8u) >> 2u {
        case 0u: { return vec3<f32>(signs.x, signs.y, 0.0); }
        case 1u: { return vec3<f32>(signs.x, 0.0, signs.y); }
        default: { return vec3<f32>(0.0, signs.x, signs.y); }
    }
}

// Returns the radius of the star in world units. It is `sample_radius` at the camera, and grows
// with the distance from the camera in relation to the light's range, as in the tutorial.
// `camera.w` is 0 where the frame has no camera.
fn shadow_direction_star_radius(view: ShadowViewUniform, position: vec3<f32>) -> f32 {
    let far = distance(position, view.camera.xyz) / view.range;
    return view.sample_radius * (1.0 + view.camera.w * far);
}

// Returns the radius of the grid in world units, which is the same everywhere.
fn shadow_direction_grid_radius(view: ShadowViewUniform, position: vec3<f32>) -> f32 {
    return view.sample_radius;
}

// Returns the point, relative to the light, at which the sample along `from_light + offset` meets
// the receiver's plane, moved toward the light to the receiver's distance where it lies farther
// away.
fn shadow_direction_on_plane(
    from_light: vec3<f32>,
    normal: vec3<f32>,
    offset: vec3<f32>,
) -> vec3<f32> {
    let direction = normalize(from_light + offset);
    let reach = length(from_light);
    let hit = dot(normal, from_light) / dot(normal, direction);
    // Where the plane is seen edge-on or from behind, the sample lies at the receiver's own
    // distance.
    return direction * select(reach, min(hit, reach), hit > 0.0);
}

// Returns the sample along `from_light + offset` at the receiver's own distance, relative to the
// light.
fn shadow_direction_on_sphere(from_light: vec3<f32>, offset: vec3<f32>) -> vec3<f32> {
    return normalize(from_light + offset) * length(from_light);
}
