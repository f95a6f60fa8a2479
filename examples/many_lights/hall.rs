//! Holds the hall on the device: what is drawn, and the same as casters.

use example_support::hall;
use example_support::mesh::{Object, Vertex};
use wgpu_shadows::{
    CasterPipeline, MeshCaster, ShadowCaster, caster::CasterPipelineDescriptor,
    caster::CasterVertex, caster::ModelTransform, caster::PositionAttribute, error::CasterError,
};

/// Holds what is drawn, and the same as casters.
pub struct Hall {
    objects: Vec<Object>,
    casters: Vec<MeshCaster>,
}

impl Hall {
    pub fn new(device: &wgpu::Device) -> Result<Self, CasterError> {
        let objects: Vec<Object> = hall::parts()
            .iter()
            .map(|(mesh, instance)| Object::new(device, mesh, *instance))
            .collect();
        let pipeline = CasterPipeline::new(
            device,
            &CasterPipelineDescriptor {
                label: Some("hall caster"),
                vertex: CasterVertex::BuiltIn {
                    position: PositionAttribute::float32x3(size_of::<Vertex>() as u64),
                    model: ModelTransform::INSTANCE_MATRIX,
                },
                ..Default::default()
            },
        )?;
        let casters = objects
            .iter()
            .map(|object| object.caster(device, &pipeline))
            .collect::<Result<_, _>>()?;
        Ok(Self { objects, casters })
    }

    pub fn objects(&self) -> &[Object] {
        &self.objects
    }

    /// Returns everything as casters, walls and floor included: the library finds for each light
    /// what nothing can lie behind.
    pub fn casters(&self) -> Vec<&dyn ShadowCaster> {
        self.casters.iter().map(|caster| caster as _).collect()
    }
}
