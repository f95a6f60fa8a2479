//! Implements a building as a caster: one instance of a mesh that many share.

use example_support::mesh::{Instance, Mesh};
use wgpu_shadows::{Aabb, CasterPipeline, Revision, ShadowCaster, ShadowView};

/// Is one instance in the town's buffer. wgpu's buffers and the library's pipelines are handles,
/// and cheap to clone.
pub struct Building {
    vertices: wgpu::Buffer,
    vertex_count: u32,
    instances: wgpu::Buffer,
    index: u32,
    bounds: Aabb,
    pipeline: CasterPipeline,
}

impl Building {
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
            bounds: mesh.bounds_model.transformed(&instance.render_from_model),
            pipeline: pipeline.clone(),
        }
    }
}

impl ShadowCaster for Building {
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

    fn keeps_pass_state(&self) -> bool {
        true
    }

    fn revision(&self) -> Option<Revision> {
        // Buildings never change.
        Some(Revision::new(u64::from(self.index), 0))
    }
}
