//! Holds the town on the device: everything in one instance buffer.

use example_support::instance_caster::{self, InstanceCaster};
use example_support::mesh::{Instance, Mesh, cube, sphere, vertex_buffer};
use example_support::phong::Batch;
use example_support::town::Plan;
use wgpu_shadows::{Aabb, DepthFormat, error::CasterError};

/// Is the number of blocks along each side of the town.
const BLOCKS: i32 = 18;

/// Holds the town.
pub struct Town {
    pub buildings: Vec<InstanceCaster>,
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
        let first_building = ground.len();
        let first_dome = first_building + houses.len();
        let list: Vec<Instance> = ground.into_iter().chain(houses).chain(domes).collect();
        let instances = vertex_buffer(device, &list);
        let box_mesh = Mesh::new(device, &cube());
        let dome_mesh = Mesh::new(device, &sphere(24));
        let pipeline = instance_caster::pipeline(device, "building", &[DepthFormat::Float32])?;
        let buildings = (0..)
            .zip(&list)
            .skip(first_building)
            .map(|(index, instance)| {
                let mesh = if (index as usize) < first_dome {
                    &box_mesh
                } else {
                    &dome_mesh
                };
                InstanceCaster::new(mesh, &instances, index, instance, &pipeline)
            })
            .collect();
        Ok(Self {
            buildings,
            ground: ground_bounds,
            box_mesh,
            dome_mesh,
            instances,
            first_dome: first_dome as u32,
            instance_count: list.len() as u32,
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
