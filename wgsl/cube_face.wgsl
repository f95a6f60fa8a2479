// Selects the face of the cube around a point light. CPU counterpart: src/light/omni.rs.

// Returns the face on which a position lies, given the vector from the light to it: +x, -x, +y, -y, +z, -z are 0 to 5.
// Every vector has exactly one face. Where components are equal, zero included, x is taken before y and y before z.
fn shadow_cube_face(from_light: vec3<f32>) -> u32 {
    let reach = abs(from_light);
    if reach.x >= reach.y && reach.x >= reach.z {
        return select(0u, 1u, from_light.x < 0.0);
    }
    if reach.y >= reach.z {
        return select(2u, 3u, from_light.y < 0.0);
    }
    return select(4u, 5u, from_light.z < 0.0);
}
