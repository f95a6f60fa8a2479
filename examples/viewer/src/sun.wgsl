// Contains the fragment stages of the viewer. The text before this one defines Blinn-Phong, and the
// one before that `shadow_sun`. The host defines in front of this one `HAZE`, the linear colour of
// the sky, and `HAZE_DENSITY`, the reciprocal of the haze's distance; and behind it
// `lit(surface, normal)`.

// Returns the geometric normal on the side that is seen.
fn facing_normal(surface: Surface) -> vec3<f32> {
    return shadow_geometric_normal(surface.position, frame.eye - surface.position);
}

// Returns the sRGB code of a linear colour: the target stores codes.
fn encoded(color: vec3<f32>) -> vec4<f32> {
    let linear = clamp(color, vec3<f32>(0.0), vec3<f32>(1.0));
    let high = 1.055 * pow(linear, vec3<f32>(1.0 / 2.4)) - 0.055;
    return vec4<f32>(select(high, 12.92 * linear, linear <= vec3<f32>(0.0031308)), 1.0);
}

fn in_the_haze(color: vec3<f32>, position: vec3<f32>) -> vec3<f32> {
    return mix(HAZE, color, exp(-distance(position, frame.eye) * HAZE_DENSITY));
}

@fragment
fn fragment_picture(surface: Surface) -> @location(0) vec4<f32> {
    // Derivatives are taken by all pixels alike, hence before the branch.
    let color = lit(surface, facing_normal(surface));
    if surface.checker < 0.0 {
        // What shines by itself has its own colour; a sky is paler toward the horizon.
        let way = normalize(surface.position - frame.eye);
        let pale = select(0.0, exp(-6.0 * max(way.y, 0.0)), HAZE_DENSITY > 0.0);
        return encoded(mix(surface.albedo, HAZE, pale));
    }
    return encoded(in_the_haze(color, surface.position));
}

// Writes the visibility of the sun as grey, darker by a little where the surface faces away.
@fragment
fn fragment_grey(surface: Surface) -> @location(0) vec4<f32> {
    let normal = facing_normal(surface);
    let visibility = shadow_sun(surface.position, normal);
    let faces = dot(normal, frame.light.xyz) > 0.0 && surface.checker >= 0.0;
    let grey = vec3<f32>(select(0.25, 0.06 + 0.9 * visibility, faces));
    return vec4<f32>(grey, 1.0);
}

// Writes the visibility of the sun alone, for measuring.
@fragment
fn fragment_visibility(surface: Surface) -> @location(0) vec4<f32> {
    let visibility = shadow_sun(surface.position, facing_normal(surface));
    return vec4<f32>(visibility, 0.0, 0.0, 1.0);
}
