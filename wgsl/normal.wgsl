// Computes the geometric normal of a fragment's surface, for engines whose vertices carry only
// shading normals.
//
// The normal is computed from screen-space derivatives of the position. It is constant over a
// triangle, and is available only in fragment shaders, in uniform control flow. Shading normals
// differ from it by up to the angle between facets, which shows as acne.
//
// Far from the origin of render space it is rounded: it errs by up to 8 u P / f radians, with P the
// largest coordinate of the position, f the size of a pixel on the surface and u = 2^-24. No bias
// allows for that. In an image of 1000 pixels a radian, at a distance d from the camera, it is 5e-4
// P / d: below two degrees up to P = 70 d, and noise from P = 2000 d on, which shows as specks of
// acne close to the camera. Let the origin of render space follow the camera, or pass the mesh's
// own normal of the triangle there.

// Returns the unit normal at `position` (render space) on the side of `toward_viewer`, a vector
// from the surface of any length but zero, so that dot(normal, toward_viewer) >= 0. For a
// perspective camera that vector is camera_position - position, for an orthographic one the reverse
// of its view direction. Derivatives alone do not determine the side: a projection that mirrors (a
// planar reflection, a target whose y points down, a captured cube map) reverses them. An
// interpolated shading normal also works as `toward_viewer`, but fails at silhouettes, where it
// points behind the facet. A normal on the wrong side makes a bias push the receiver into its own
// surface, which shows as acne everywhere.
fn shadow_geometric_normal(position: vec3<f32>, toward_viewer: vec3<f32>) -> vec3<f32> {
    let across = dpdx(position);
    let down = dpdy(position);
    // All three vectors are first scaled by their largest component: products of small or large
    // ones would leave the range of f32.
    let step = max(abs(across), abs(down));
    let scale = max(max(max(step.x, step.y), step.z), 1e-37);
    let turned = cross(down / scale, across / scale);
    let normal = turned / max(length(turned), 1e-20);
    let reach = abs(toward_viewer);
    let side = toward_viewer / max(max(reach.x, reach.y), reach.z);
    // The comparison is false where the side is zero or NaN; the derivatives then determine the
    // side.
    return select(normal, -normal, dot(normal, side) < 0.0);
}
