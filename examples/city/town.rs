//! Holds the town on the device: everything in one instance buffer.

use example_support::mesh::{Instance, Mesh, copies_pipeline, cube, sphere, vertex_buffer};
use example_support::phong::Batch;
use example_support::town::Plan;
use wgpu_shadows::{Aabb, DepthFormat, InstancedMeshCaster, error::CasterError};

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
        let pipeline = copies_pipeline(device, &[DepthFormat::Float32])?;
        let casters = [
            box_mesh.copies(device, &pipeline, &houses)?,
            dome_mesh.copies(device, &pipeline, &domes)?,
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
