//! Implements one instance of a mesh as a caster, where many instances share one buffer.

use wgpu_shadows::{
    Aabb, CasterPipeline, Revision, ShadowCaster, ShadowView, caster::CasterPipelineDescriptor,
    caster::CasterShape, caster::CasterVertex, caster::ModelTransform, caster::PositionAttribute,
    error::CasterError,
};

use crate::mesh::{Instance, Mesh, Vertex};

/// Is one instance in a buffer. wgpu's buffers and the library's pipelines are handles, and cheap
/// to clone.
pub struct InstanceCaster {
    vertices: wgpu::Buffer,
    vertex_count: u32,
    instances: wgpu::Buffer,
    index: u32,
    bounds_model: Aabb,
    bounds: Aabb,
    shape_model: CasterShape,
    shape: CasterShape,
    id: u64,
    version: u64,
    pipeline: CasterPipeline,
}

impl InstanceCaster {
    /// Makes the caster of the instance at `index` of `instances`. Its revision is that of this
    /// index.
    pub fn new(
        mesh: &Mesh,
        instances: &wgpu::Buffer,
        index: u32,
        instance: &Instance,
        pipeline: &CasterPipeline,
    ) -> Self {
        Self {
            vertices: mesh.vertices.clone(),
            vertex_count: mesh.vertex_count,
            instances: instances.clone(),
            index,
            bounds_model: mesh.bounds_model,
            bounds: mesh.bounds_model.transformed(&instance.render_from_model),
            shape_model: CasterShape::Any,
            shape: CasterShape::Any,
            id: u64::from(index),
            version: 0,
            pipeline: pipeline.clone(),
        }
    }

    /// Sets an id for scenes of several buffers, and the shape of the mesh in model space.
    pub fn with_id_and_shape(self, id: u64, shape_model: CasterShape, instance: &Instance) -> Self {
        Self {
            id,
            shape_model,
            shape: shape_model.transformed(&instance.render_from_model),
            ..self
        }
    }

    /// Tells that the instance in the buffer is now this one.
    pub fn set_instance(&mut self, instance: &Instance) {
        self.bounds = self.bounds_model.transformed(&instance.render_from_model);
        self.shape = self.shape_model.transformed(&instance.render_from_model);
        self.version += 1;
    }
}

impl ShadowCaster for InstanceCaster {
    fn bounds(&self) -> Aabb {
        self.bounds
    }

    fn pipeline(&self) -> &CasterPipeline {
        &self.pipeline
    }

    fn draw(&self, pass: &mut wgpu::RenderPass<'_>, _view: &ShadowView) {
        pass.set_vertex_buffer(0, self.vertices.slice(..));
        pass.set_vertex_buffer(1, self.instances.slice(..));
        pass.draw(0..self.vertex_count, self.index..self.index + 1);
    }

    fn shape(&self) -> CasterShape {
        self.shape
    }

    fn keeps_pass_state(&self) -> bool {
        true
    }

    fn same_in_every_view(&self) -> bool {
        true
    }

    fn triangles(&self) -> u32 {
        self.vertex_count / 3
    }

    fn revision(&self) -> Option<Revision> {
        Some(Revision::new(self.id, self.version))
    }
}

/// Creates a pipeline that reads the matrices where the scene's pass reads them: in the instance
/// buffer. Its casters can be drawn into maps of these formats.
pub fn pipeline(
    device: &wgpu::Device,
    label: &str,
    depth_formats: &[wgpu_shadows::DepthFormat],
) -> Result<CasterPipeline, CasterError> {
    CasterPipeline::new(
        device,
        &CasterPipelineDescriptor {
            label: Some(label),
            vertex: CasterVertex::BuiltIn {
                position: PositionAttribute::float32x3(size_of::<Vertex>() as u64),
                model: ModelTransform::InstanceMatrix {
                    array_stride: size_of::<Instance>() as u64,
                    offset: 0,
                },
            },
            depth_formats,
            ..Default::default()
        },
    )
}
