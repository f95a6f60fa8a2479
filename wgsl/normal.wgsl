// The geometric normal of the surface a fragment lies on, for engines that carry only shading normals.
//
// From screen-space derivatives of the position: constant over a triangle, and only in a fragment shader, in uniform control
// flow. Shading normals differ from it by up to the angle between facets, which shows as acne.

// The unit normal at `position` on the side of `toward_viewer`, a vector from the surface of any length: dot(normal,
// toward_viewer) >= 0. For a perspective camera that is camera_position - position, for an orthographic one the reverse of its
// direction of view. Derivatives alone cannot tell the side: a projection that mirrors (of a planar reflection, of a target with
// y downward, of a captured cube) swaps it. An interpolated shading normal serves as well, but errs at silhouettes, where it
// leans behind the facet. On the wrong side a bias pushes the receiver into the surface, which shows as acne all over.
fn shadow_geometric_normal(position: vec3<f32>, toward_viewer: vec3<f32>) -> vec3<f32> {
    let across = dpdx(position);
    let down = dpdy(position);
    // Scaled first, all three by their largest component: a product of small or large ones would leave f32's range.
    let step = max(abs(across), abs(down));
    let scale = max(max(max(step.x, step.y), step.z), 1e-37);
    let turned = cross(down / scale, across / scale);
    let normal = turned / max(length(turned), 1e-20);
    let reach = abs(toward_viewer);
    let side = toward_viewer / max(max(reach.x, reach.y), reach.z);
    // False where the side is zero or not a number: then the derivatives' own.
    return select(normal, -normal, dot(normal, side) < 0.0);
}
