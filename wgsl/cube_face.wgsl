// Which face of a cube around a point light a place lies on: +x, -x, +y, -y, +z, -z are 0 to 5.
//
// Exactly one for every direction, ties and zero included: x before y before z. Rust twin: src/omni.rs.

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
