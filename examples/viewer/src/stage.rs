//! Holds a scene on the device: meshes, instances and casters.

use bytemuck::cast_slice;
use example_support::mesh::{Instance, Mesh, copies_pipeline, transforms};
use example_support::phong::Batch;
use glam::Vec3;
use wgpu::util::{BufferInitDescriptor, DeviceExt};
use wgpu_shadows::{
    Aabb, CasterPipeline, DepthFormat, InstancedMeshCaster, ShadowCaster, caster::CasterShape,
    caster::caster_shape, error::CasterError,
};

use crate::leaves::{self, LeafCaster};
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
    caster: Option<ModelCaster>,
    path: Option<fn(f32) -> Vec<Instance>>,
}

/// Is what casts for a model.
enum ModelCaster {
    Copies(InstancedMeshCaster),
    Leaves(LeafCaster),
}

impl Stage {
    pub fn new(device: &wgpu::Device, scene: &Scene) -> Result<Self, CasterError> {
        let formats = [DepthFormat::Float32, DepthFormat::Unorm16];
        let pipelines = Pipelines {
            copies: copies_pipeline(device, &formats)?,
            leaves: leaves::pipeline(device, &formats)?,
        };
        let models = scene.models.iter().enumerate();
        let models = models.map(|(index, model)| DrawnModel::new(device, model, index, &pipelines));
        Ok(Self {
            models: models.collect::<Result<_, _>>()?,
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
    ///
    /// # Errors
    /// Returns an error for a model with more instances at one time than at another.
    pub fn set_time(&mut self, queue: &wgpu::Queue, time: f32) -> Result<(), CasterError> {
        for model in &mut self.models {
            let Some(path) = model.path else { continue };
            let instances = path(time);
            queue.write_buffer(&model.instances, 0, cast_slice(&instances));
            if let Some(ModelCaster::Copies(caster)) = &mut model.caster {
                caster.set_transforms(0, &transforms(&instances))?;
            }
        }
        Ok(())
    }

    pub fn casters(&self) -> Vec<&dyn ShadowCaster> {
        let casters = self.models.iter().filter_map(|model| model.caster.as_ref());
        casters.map(ModelCaster::caster).collect()
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

/// Holds the pipelines of all casters.
struct Pipelines {
    copies: CasterPipeline,
    leaves: CasterPipeline,
}

impl ModelCaster {
    fn caster(&self) -> &dyn ShadowCaster {
        match self {
            Self::Copies(caster) => caster,
            Self::Leaves(caster) => caster,
        }
    }
}

impl DrawnModel {
    fn new(
        device: &wgpu::Device,
        model: &Model,
        index: usize,
        pipelines: &Pipelines,
    ) -> Result<Self, CasterError> {
        let mesh = Mesh::new(device, &model.vertices);
        let instances = device.create_buffer_init(&BufferInitDescriptor {
            label: Some("instances"),
            contents: cast_slice(&model.instances),
            usage: wgpu::BufferUsages::VERTEX | wgpu::BufferUsages::COPY_DST,
        });
        let count = model.instances.len() as u32;
        let caster = match model.role {
            Role::Solid => {
                let mut caster = mesh.copies(device, &pipelines.copies, &model.instances)?;
                caster.set_shape(shape(model));
                Some(ModelCaster::Copies(caster))
            }
            Role::Leaves => {
                let cards = (&instances, count);
                let bounds = model.bounds();
                let caster = LeafCaster::new(device, &pipelines.leaves, cards, bounds, index);
                Some(ModelCaster::Leaves(caster))
            }
            Role::Ground | Role::Glow => None,
        };
        Ok(Self {
            caster,
            count,
            instances,
            mesh,
            path: model.path,
        })
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
