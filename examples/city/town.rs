//! Holds the town on the device: everything in one instance buffer.

use example_support::mesh::{Instance, Mesh, Vertex, cube, sphere, vertex_buffer};
use example_support::phong::Batch;
use example_support::town::Plan;
use glam::Mat4;
use wgpu_shadows::{
    Aabb, CasterPipeline, InstancedMeshCaster, caster::CasterPipelineDescriptor,
    caster::CasterVertex, caster::InstancedMeshCasterDescriptor, caster::MeshIndices,
    caster::ModelTransform, caster::PositionAttribute, error::CasterError,
};

/// Is the number of blocks along each side of the town.
const BLOCKS: i32 = 18;

/// Holds the town.
pub struct Town {
    /// Holds all buildings: the boxes, and the domes.
    pub casters: [InstancedMeshCaster; 2],
    /// Bounds what only receives: streets and pavements.
    pub ground: Aabb,
    box_mesh: Mesh,
    dome_mesh: Mesh,
    instances: wgpu::Buffer,
    /// Is the index of the first dome. The instances are, in order: ground and pavements, buildings
    /// that are boxes, domes.
    first_dome: u32,
    instance_count: u32,
}

impl Town {
    pub fn new(device: &wgpu::Device) -> Result<Self, CasterError> {
        let Plan {
            ground,
            houses,
            domes,
            ground_bounds,
        } = Plan::new(BLOCKS);
        let box_mesh = Mesh::new(device, &cube());
        let dome_mesh = Mesh::new(device, &sphere(24));
        let pipeline = caster_pipeline(device)?;
        let casters = [
            copies(device, &pipeline, &box_mesh, &houses)?,
            copies(device, &pipeline, &dome_mesh, &domes)?,
        ];
        let first_dome = (ground.len() + houses.len()) as u32;
        let instances: Vec<Instance> = ground.into_iter().chain(houses).chain(domes).collect();
        Ok(Self {
            casters,
            ground: ground_bounds,
            box_mesh,
            dome_mesh,
            instance_count: instances.len() as u32,
            instances: vertex_buffer(device, &instances),
            first_dome,
        })
    }

    /// Returns all of the town in two draws.
    pub fn batches(&self) -> [Batch<'_>; 2] {
        let batch = |mesh, range| Batch {
            mesh,
            instances: &self.instances,
            range,
        };
        [
            batch(&self.box_mesh, 0..self.first_dome),
            batch(&self.dome_mesh, self.first_dome..self.instance_count),
        ]
    }
}

/// Makes one caster of many buildings, each of which is culled by itself.
fn copies(
    device: &wgpu::Device,
    pipeline: &CasterPipeline,
    mesh: &Mesh,
    instances: &[Instance],
) -> Result<InstancedMeshCaster, CasterError> {
    let transforms = instances.iter().map(|instance| instance.render_from_model);
    let transforms: Vec<Mat4> = transforms.collect();
    let descriptor = InstancedMeshCasterDescriptor {
        label: Some("buildings"),
        pipeline,
        vertices: &mesh.vertices,
        indices: MeshIndices::None {
            vertices: 0..mesh.vertex_count,
        },
        bounds_model: mesh.bounds_model,
        render_from_model: &transforms,
    };
    InstancedMeshCaster::new(device, &descriptor)
}

fn caster_pipeline(device: &wgpu::Device) -> Result<CasterPipeline, CasterError> {
    CasterPipeline::new(
        device,
        &CasterPipelineDescriptor {
            label: Some("building"),
            vertex: CasterVertex::BuiltIn {
                position: PositionAttribute::float32x3(size_of::<Vertex>() as u64),
                model: ModelTransform::INSTANCE_MATRIX,
            },
            ..Default::default()
        },
    )
}
