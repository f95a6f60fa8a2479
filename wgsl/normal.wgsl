// The geometric normal of the surface a fragment lies on, for engines that carry only shading normals.
//
// From screen-space derivatives of the position: constant over a triangle, toward the viewer, and only in a fragment shader,
// in uniform control flow. Shading normals differ from it by up to the angle between facets, which shows as acne.

fn shadow_geometric_normal(position: vec3<f32>) -> vec3<f32> {
    let across = dpdx(position);
    let down = dpdy(position);
    // Scaled first: a cross product of small steps would underflow.
    let scale = max(length(across), length(down));
    let turned = cross(down / scale, across / scale);
    return turned / max(length(turned), 1e-20);
}
