//! Is a caster that records what the library does with it, and returns wrong values where a test needs them.

use std::cell::Cell;

use wgpu_shadows::{Aabb, CasterPipeline, MeshCaster, Revision, ShadowCaster, ShadowView};

/// Is a mesh that counts how often it is drawn, with a revision and bounds that the test chooses.
pub struct Watched {
    pub mesh: MeshCaster,
    pub revision: Option<Option<Revision>>,
    pub bounds: Option<Aabb>,
    pub draws: Cell<u32>,
}

impl Watched {
    pub fn new(mesh: MeshCaster) -> Self {
        Self {
            mesh,
            revision: None,
            bounds: None,
            draws: Cell::new(0),
        }
    }

    pub fn with_bounds(mesh: MeshCaster, bounds: Aabb) -> Self {
        Self {
            bounds: Some(bounds),
            ..Self::new(mesh)
        }
    }
}

impl ShadowCaster for Watched {
    fn bounds(&self) -> Aabb {
        self.bounds.unwrap_or(self.mesh.bounds())
    }

    fn pipeline(&self) -> &CasterPipeline {
        self.mesh.pipeline()
    }

    fn draw(&self, pass: &mut wgpu::RenderPass<'_>, view: &ShadowView) {
        self.draws.set(self.draws.get() + 1);
        self.mesh.draw(pass, view);
    }

    fn revision(&self) -> Option<Revision> {
        self.revision.unwrap_or(self.mesh.revision())
    }
}
