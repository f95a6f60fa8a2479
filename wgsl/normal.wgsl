// Computes the geometric normal of a fragment's surface, for engines whose vertices carry only shading normals.
//
// The normal is computed from screen-space derivatives of the position. It is constant over a triangle, and is
// available only in fragment shaders, in uniform control flow. Shading normals differ from it by up to the angle
// between facets, which shows as acne.

// Returns the unit normal at `position` (render space) on the side of `toward_viewer`, a vector from the surface of any
// length but zero, so that dot(normal, toward_viewer) >= 0. For a perspective camera that vector is camera_position -
// position, for an orthographic one the reverse of its view direction. Derivatives alone do not determine the side: a
// projection that mirrors (a planar reflection, a target whose y points down, a captured cube map) reverses them. An
// interpolated shading normal also works as `toward_viewer`, but fails at silhouettes, where it points behind the
// facet. A normal on the wrong side makes a bias push the receiver into its own surface, which shows as acne
// everywhere.
fn shadow_geometric_normal(position: vec3<f32>, toward_viewer: vec3<f32>) -> vec3<f32> {
    let across = dpdx(position);
    let down = dpdy(position);
    // All three vectors are first scaled by their largest component: products of small or large ones would leave the
    // range of f32.
    let step = max(abs(across), abs(down));
    let scale = max(max(max(step.x, step.y), step.z), 1e-37);
    let turned = cross(down / scale, across / scale);
    let normal = turned / max(length(turned), 1e-20);
    let reach = abs(toward_viewer);
    let side = toward_viewer / max(max(reach.x, reach.y), reach.z);
    // The comparison is false where the side is zero or NaN; the derivatives then determine the side.
    return select(normal, -normal, dot(normal, side) < 0.0);
}
