//! Holds a scene on the device: meshes, instances and casters.

use bytemuck::cast_slice;
use example_support::instance_caster::{self, InstanceCaster};
use example_support::mesh::{Instance, Mesh};
use example_support::phong::Batch;
use glam::Vec3;
use wgpu::util::{BufferInitDescriptor, DeviceExt};
use wgpu_shadows::{
    Aabb, CasterPipeline, DepthFormat, ShadowCaster, caster::CasterShape, caster::caster_shape,
    error::CasterError,
};

use crate::scene::{Model, Role, Scene};

/// Holds what is drawn of a scene.
pub struct Stage {
    models: Vec<DrawnModel>,
    /// Bounds what only receives.
    receivers: Vec<Aabb>,
    bounds: Aabb,
}

struct DrawnModel {
    mesh: Mesh,
    instances: wgpu::Buffer,
    count: u32,
    casters: Vec<InstanceCaster>,
    path: Option<fn(f32) -> Vec<Instance>>,
}

impl Stage {
    pub fn new(device: &wgpu::Device, scene: &Scene) -> Result<Self, CasterError> {
        let formats = [DepthFormat::Float32, DepthFormat::Unorm16];
        let pipeline = instance_caster::pipeline(device, "viewer caster", &formats)?;
        let mut next_id = 0;
        let models = scene.models.iter();
        Ok(Self {
            models: models
                .map(|model| DrawnModel::new(device, model, &pipeline, &mut next_id))
                .collect(),
            receivers: scene
                .models
                .iter()
                .filter(|model| model.role == Role::Ground)
                .map(Model::bounds)
                .collect(),
            bounds: scene.bounds(),
        })
    }

    /// Puts what moves where it is at a time in seconds.
    pub fn set_time(&mut self, queue: &wgpu::Queue, time: f32) {
        for model in &mut self.models {
            let Some(path) = model.path else { continue };
            let instances = path(time);
            queue.write_buffer(&model.instances, 0, cast_slice(&instances));
            for (caster, instance) in model.casters.iter_mut().zip(&instances) {
                caster.set_instance(instance);
            }
        }
    }

    pub fn casters(&self) -> Vec<&dyn ShadowCaster> {
        let casters = self.models.iter().flat_map(|model| &model.casters);
        casters.map(|caster| caster as _).collect()
    }

    pub fn receivers(&self) -> &[Aabb] {
        &self.receivers
    }

    pub fn bounds(&self) -> Aabb {
        self.bounds
    }

    pub fn batches(&self) -> impl Iterator<Item = Batch<'_>> {
        self.models.iter().map(|model| Batch {
            mesh: &model.mesh,
            instances: &model.instances,
            range: 0..model.count,
        })
    }
}

impl DrawnModel {
    fn new(
        device: &wgpu::Device,
        model: &Model,
        pipeline: &CasterPipeline,
        next_id: &mut u64,
    ) -> Self {
        let mesh = Mesh::new(device, &model.vertices);
        let instances = device.create_buffer_init(&BufferInitDescriptor {
            label: Some("instances"),
            contents: cast_slice(&model.instances),
            usage: wgpu::BufferUsages::VERTEX | wgpu::BufferUsages::COPY_DST,
        });
        let shape = shape(model);
        let casts = model.role == Role::Solid;
        let casters = (0..).zip(model.instances.iter().filter(|_| casts));
        let casters = casters.map(|(index, instance)| {
            *next_id += 1;
            InstanceCaster::new(&mesh, &instances, index, instance, pipeline)
                .with_id_and_shape(*next_id, shape, instance)
        });
        Self {
            casters: casters.collect(),
            count: model.instances.len() as u32,
            mesh,
            instances,
            path: model.path,
        }
    }
}

/// Returns the shape of a mesh that has no indices.
fn shape(model: &Model) -> CasterShape {
    let positions: Vec<Vec3> = model
        .vertices
        .iter()
        .map(|vertex| vertex.position)
        .collect();
    // Corners at one place count as one, as in a mesh with indices.
    let mut places: Vec<Vec3> = Vec::new();
    let mut known = std::collections::HashMap::new();
    let indices: Vec<u32> = positions
        .iter()
        .map(|position| {
            let key = position.to_array().map(|value| (value + 0.0).to_bits());
            *known.entry(key).or_insert_with(|| {
                places.push(*position);
                places.len() as u32 - 1
            })
        })
        .collect();
    caster_shape(&places, &indices)
}
