//! Meshes as the engine keeps them: a vertex buffer, and one instance with a matrix and a colour.

use bytemuck::{NoUninit, Pod, Zeroable};
use glam::{Mat4, Vec3};
use wgpu::util::{BufferInitDescriptor, DeviceExt};
use wgpu_shadows::Aabb;

/// A vertex; the library reads its position, the engine's shader its normal too.
#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
pub struct Vertex {
    pub position: Vec3,
    pub normal: Vec3,
}

/// What the engine's shader knows of an object.
#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
pub struct Instance {
    pub render_from_model: Mat4,
    pub albedo: Vec3,
    /// Contrast of the squares on the surface; 0 leaves it plain.
    pub checker: f32,
}

/// A mesh that stands somewhere.
pub struct Object {
    pub vertices: wgpu::Buffer,
    pub vertex_count: u32,
    pub bounds_model: Aabb,
    pub instance: wgpu::Buffer,
    pub render_from_model: Mat4,
}

impl Object {
    pub fn new(device: &wgpu::Device, mesh: &[Vertex], instance: Instance) -> Self {
        Self {
            vertices: vertex_buffer(device, mesh),
            vertex_count: mesh.len() as u32,
            bounds_model: Aabb::from_points(mesh.iter().map(|vertex| vertex.position)),
            instance: vertex_buffer(device, &[instance]),
            render_from_model: instance.render_from_model,
        }
    }
}

/// The cube from -1 to 1.
pub fn cube() -> Vec<Vertex> {
    [Vec3::X, Vec3::Y, Vec3::Z]
        .into_iter()
        .flat_map(|axis| [square(axis, 1.0), square(-axis, 1.0)])
        .flatten()
        .collect()
}

/// A square of half side 1 whose front looks along `out`, an axis, from `distance` in that direction: two triangles,
/// counter-clockwise as seen from the front.
pub fn square(out: Vec3, distance: f32) -> [Vertex; 6] {
    let right = Vec3::new(out.y, out.z, out.x);
    let up = out.cross(right);
    [
        (-1.0, -1.0),
        (1.0, -1.0),
        (1.0, 1.0),
        (1.0, 1.0),
        (-1.0, 1.0),
        (-1.0, -1.0),
    ]
    .map(|(x, y)| Vertex {
        position: out * distance + right * x + up * y,
        normal: out,
    })
}

fn vertex_buffer<T: NoUninit>(device: &wgpu::Device, contents: &[T]) -> wgpu::Buffer {
    device.create_buffer_init(&BufferInitDescriptor {
        label: Some("mesh"),
        contents: bytemuck::cast_slice(contents),
        usage: wgpu::BufferUsages::VERTEX,
    })
}
