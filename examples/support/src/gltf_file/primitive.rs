//! Converts one glTF primitive to a triangle list.

use gltf::mesh::Mode;

use super::scene::{Mesh, Vertex};

/// Returns the triangles of `primitive`, or the reason why it has none.
pub fn triangles(
    primitive: &gltf::Primitive<'_>,
    buffers: &[gltf::buffer::Data],
    material: usize,
    uv_set: u32,
) -> Result<Mesh, String> {
    let reader = primitive.reader(|buffer| buffers.get(buffer.index()).map(|data| &data.0[..]));
    let positions: Vec<[f32; 3]> = reader
        .read_positions()
        .ok_or("it has no positions")?
        .collect();
    let normals: Vec<[f32; 3]> = reader
        .read_normals()
        .map(Iterator::collect)
        .unwrap_or_default();
    let uvs: Vec<[f32; 2]> = reader
        .read_tex_coords(uv_set)
        .map(|uvs| uvs.into_f32().collect())
        .unwrap_or_default();
    let order: Vec<u32> = match reader.read_indices() {
        Some(indices) => indices.into_u32().collect(),
        None => (0..positions.len() as u32).collect(),
    };
    if order.iter().any(|&index| index as usize >= positions.len()) {
        return Err("its indices point past its vertices".to_owned());
    }
    let indices = match primitive.mode() {
        Mode::Triangles => {
            let whole = order.len() - order.len() % 3;
            order[..whole].to_vec()
        }
        // Every second triangle of a strip winds the other way.
        Mode::TriangleStrip => order
            .windows(3)
            .enumerate()
            .flat_map(|(i, t)| {
                if i % 2 == 0 {
                    [t[0], t[1], t[2]]
                } else {
                    [t[1], t[0], t[2]]
                }
            })
            .collect(),
        Mode::TriangleFan => match order.split_first() {
            Some((&hub, rim)) => rim.windows(2).flat_map(|t| [hub, t[0], t[1]]).collect(),
            None => Vec::new(),
        },
        mode => return Err(format!("points and lines cast no shadow ({mode:?})")),
    };
    let vertices = positions
        .iter()
        .enumerate()
        .map(|(i, &position)| Vertex {
            position,
            normal: normals.get(i).copied().unwrap_or_default(),
            uv: uvs.get(i).copied().unwrap_or_default(),
        })
        .collect();
    Ok(Mesh {
        vertices,
        indices,
        material,
    })
}
