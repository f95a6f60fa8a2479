// Selects the face of the cube around a point light, and exchanges coordinates so that they are
// along the axes of that face. CPU counterpart: src/light/omni.rs.

// Describes a face of the cube.
struct ShadowFace {
    // Is 0 to 5 for +x, -x, +y, -y, +z, -z.
    index: u32,
    // Tell which axis the face looks along: x, y, or neither of them.
    along_x: bool,
    along_y: bool,
    // Are the signs of right, down and toward the light.
    signs: vec3<f32>,
}

// Returns the face on which a position lies, given the vector from the light to it. Every vector
// has exactly one face. Where components are equal, zero included, x is taken before y and y before
// z.
fn shadow_face(from_light: vec3<f32>) -> ShadowFace {
    let reach = abs(from_light);
    let along_x = (reach.x >= reach.y) & (reach.x >= reach.z);
    let along_y = (reach.y >= reach.z) & !along_x;
    let forward = select(select(from_light.z, from_light.y, along_y), from_light.x, along_x);
    let is_negative = forward < 0.0;
    let index = select(select(4u, 2u, along_y), 0u, along_x) + select(0u, 1u, is_negative);
    // Facing +x, right is z and down is -y; facing +y, right is x and down is -z; facing +z, right
    // is -x and down is -y. On the opposite face the sign of what is horizontal changes, except
    // that facing -y, right is x and down is z.
    let side = select(-1.0, 1.0, is_negative);
    let right = select(select(side, -side, along_x), 1.0, along_y);
    let signs = vec3<f32>(right, select(-1.0, side, along_y), side);
    return ShadowFace(index, along_x, along_y, signs);
}

// Returns the number of that face.
fn shadow_cube_face(from_light: vec3<f32>) -> u32 {
    return shadow_face(from_light).index;
}

// Returns a vector of render space along the axes of a face: right, down and toward the light.
fn shadow_along_face(face: ShadowFace, vector: vec3<f32>) -> vec3<f32> {
    let right = select(vector.x, vector.z, face.along_x);
    let down = select(vector.y, vector.z, face.along_y);
    let toward = select(select(vector.z, vector.y, face.along_y), vector.x, face.along_x);
    return vec3<f32>(right, down, toward) * face.signs;
}
