//! Holds meshes as the engine keeps them: a vertex buffer, and instances with a matrix and a colour
//! each.

use std::f32::consts::{PI, TAU};

use bytemuck::{NoUninit, Pod, Zeroable};
use glam::{Mat4, Vec3};
use wgpu::util::{BufferInitDescriptor, DeviceExt};
use wgpu_shadows::{
    Aabb, CasterPipeline, DepthFormat, InstancedMeshCaster, MeshCaster,
    caster::CasterPipelineDescriptor, caster::CasterVertex, caster::InstancedMeshCasterDescriptor,
    caster::MeshCasterDescriptor, caster::MeshIndices, caster::ModelTransform,
    caster::PositionAttribute, error::CasterError,
};

/// Is a vertex; the library reads its position, and the engine's shader reads its normal as well.
#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
pub struct Vertex {
    pub position: Vec3,
    pub normal: Vec3,
}

/// Is an object as the engine's shader sees it. The library reads the matrix.
#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
pub struct Instance {
    pub render_from_model: Mat4,
    pub albedo: Vec3,
    /// Is the contrast of the squares on the surface; 0 leaves it plain.
    pub checker: f32,
}

/// Holds triangles in model space.
pub struct Mesh {
    pub vertices: wgpu::Buffer,
    pub vertex_count: u32,
    pub bounds_model: Aabb,
}

impl Mesh {
    pub fn new(device: &wgpu::Device, vertices: &[Vertex]) -> Self {
        Self {
            vertices: vertex_buffer(device, vertices),
            vertex_count: vertices.len() as u32,
            bounds_model: Aabb::from_points(vertices.iter().map(|vertex| vertex.position)),
        }
    }

    /// Returns copies of the mesh as the library draws them, each of which is culled by itself.
    /// `pipeline` is that of [`copies_pipeline`].
    pub fn copies(
        &self,
        device: &wgpu::Device,
        pipeline: &CasterPipeline,
        instances: &[Instance],
    ) -> Result<InstancedMeshCaster, CasterError> {
        InstancedMeshCaster::new(
            device,
            &InstancedMeshCasterDescriptor {
                label: Some("copies"),
                pipeline,
                vertices: &self.vertices,
                indices: MeshIndices::None {
                    vertices: 0..self.vertex_count,
                },
                bounds_model: self.bounds_model,
                render_from_model: &transforms(instances),
            },
        )
    }
}

/// Returns the transforms of instances.
pub fn transforms(instances: &[Instance]) -> Vec<Mat4> {
    let transforms = instances.iter().map(|instance| instance.render_from_model);
    transforms.collect()
}

/// Makes a pipeline for casters of [`Vertex`] with a matrix each, for maps of these formats.
pub fn copies_pipeline(
    device: &wgpu::Device,
    depth_formats: &[DepthFormat],
) -> Result<CasterPipeline, CasterError> {
    CasterPipeline::new(
        device,
        &CasterPipelineDescriptor {
            label: Some("copies"),
            vertex: CasterVertex::BuiltIn {
                position: PositionAttribute::float32x3(size_of::<Vertex>() as u64),
                model: ModelTransform::INSTANCE_MATRIX,
            },
            depth_formats,
            ..Default::default()
        },
    )
}

/// Is a mesh with its position.
pub struct Object {
    pub mesh: Mesh,
    pub instance: wgpu::Buffer,
    pub render_from_model: Mat4,
}

impl Object {
    pub fn new(device: &wgpu::Device, mesh: &[Vertex], instance: Instance) -> Self {
        Self {
            mesh: Mesh::new(device, mesh),
            instance: vertex_buffer(device, &[instance]),
            render_from_model: instance.render_from_model,
        }
    }

    /// Returns the object as the library draws it, with a pipeline for positions in [`Vertex`].
    pub fn caster(
        &self,
        device: &wgpu::Device,
        pipeline: &CasterPipeline,
    ) -> Result<MeshCaster, CasterError> {
        MeshCaster::new(
            device,
            &MeshCasterDescriptor {
                label: Some("object"),
                pipeline,
                vertices: &self.mesh.vertices,
                indices: MeshIndices::None {
                    vertices: 0..self.mesh.vertex_count,
                },
                bounds_model: self.mesh.bounds_model,
                render_from_model: self.render_from_model,
            },
        )
    }
}

/// Returns the cube from -1 to 1.
pub fn cube() -> Vec<Vertex> {
    [Vec3::X, Vec3::Y, Vec3::Z]
        .into_iter()
        .flat_map(|axis| [square(axis, 1.0), square(-axis, 1.0)])
        .flatten()
        .collect()
}

/// Returns a square of half side 1 whose front faces along `out`, an axis, from `distance` in that
/// direction: two triangles, counter-clockwise as seen from the front.
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

/// Returns the same triangles with their fronts reversed, which makes a room of a box.
pub fn inside_out(mesh: &[Vertex]) -> Vec<Vertex> {
    mesh.iter()
        .rev()
        .map(|vertex| Vertex {
            position: vertex.position,
            normal: -vertex.normal,
        })
        .collect()
}

/// Returns the sphere of radius 1 in `rings` from pole to pole, each of twice as many
/// quadrilaterals.
pub fn sphere(rings: u32) -> Vec<Vertex> {
    let corner = |(ring, step): (u32, u32)| {
        let (sine, cosine) = (PI * ring as f32 / rings as f32).sin_cos();
        let around = Vec3::Z.rotate_y(TAU * step as f32 / (2 * rings) as f32);
        let normal = around * sine + Vec3::Y * cosine;
        Vertex {
            position: normal,
            normal,
        }
    };
    (0..rings)
        .flat_map(|ring| (0..2 * rings).map(move |step| (ring, step)))
        .flat_map(|(ring, step)| {
            [
                (ring, step),
                (ring + 1, step),
                (ring + 1, step + 1),
                (ring + 1, step + 1),
                (ring, step + 1),
                (ring, step),
            ]
        })
        .map(corner)
        .collect()
}

/// Creates a buffer of vertices or instances.
pub fn vertex_buffer<T: NoUninit>(device: &wgpu::Device, contents: &[T]) -> wgpu::Buffer {
    device.create_buffer_init(&BufferInitDescriptor {
        label: Some("mesh"),
        contents: bytemuck::cast_slice(contents),
        usage: wgpu::BufferUsages::VERTEX,
    })
}
