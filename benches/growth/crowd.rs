//! Provides many boxes as casters, all in one pair of buffers.

use glam::Vec3;
use shadow_support::gpu::Gpu;
use shadow_support::mesh::{Mesh, render_space_pipeline};
use shadow_support::random::Random;
use wgpu_shadows::{Aabb, CasterPipeline, Revision, ShadowCaster, ShadowView};

/// Holds boxes on a square of ground, one caster each.
pub struct Crowd {
    pub boxes: Vec<BoxCaster>,
    /// Holds the same boxes as separate meshes, for drawing without the library.
    pub parts: Vec<Mesh>,
    pub mesh: Mesh,
}

/// Is a caster of an engine's own, which draws its part of shared buffers.
pub struct BoxCaster {
    pub pipeline: CasterPipeline,
    pub vertices: wgpu::Buffer,
    pub indices: wgpu::Buffer,
    pub first_vertex: i32,
    pub index_count: u32,
    /// Is the number of triangles that the library is told of.
    pub told_triangles: u32,
    pub bounds: Aabb,
    pub id: u64,
    /// Counts its changes; `None` where it changes in every frame.
    pub version: Option<u64>,
}

impl Crowd {
    /// Makes `count` boxes with four metres of ground each.
    pub fn new(gpu: &Gpu, count: u32) -> Self {
        let half = half_side(count);
        let mut random = Random::new(31);
        let meshes: Vec<Mesh> = (0..count)
            .map(|_| {
                let foot = Vec3::new(
                    random.between(-half, half),
                    0.0,
                    random.between(-half, half),
                );
                let size = Vec3::new(
                    random.between(0.3, 1.0),
                    random.between(0.3, 3.0),
                    random.between(0.3, 1.0),
                );
                Mesh::standing_box(foot, size, random.between(0.0, 3.0))
            })
            .collect();
        let positions: Vec<Vec3> = meshes
            .iter()
            .flat_map(|mesh| &mesh.positions)
            .copied()
            .collect();
        let pipeline = render_space_pipeline(gpu);
        let vertices = gpu.buffer(&positions, wgpu::BufferUsages::VERTEX);
        let indices = gpu.buffer(&meshes[0].indices, wgpu::BufferUsages::INDEX);
        let mut first_vertex = 0;
        let mut boxes = Vec::new();
        for (id, mesh) in (0..).zip(&meshes) {
            boxes.push(BoxCaster {
                pipeline: pipeline.clone(),
                vertices: vertices.clone(),
                indices: indices.clone(),
                first_vertex,
                index_count: mesh.indices.len() as u32,
                told_triangles: mesh.indices.len() as u32 / 3,
                bounds: mesh.bounds(),
                id,
                version: Some(0),
            });
            first_vertex += mesh.positions.len() as i32;
        }
        let joined = (0u32..).zip(&meshes).flat_map(|(index, mesh)| {
            let first = index * mesh.positions.len() as u32;
            mesh.indices.iter().map(move |vertex| first + vertex)
        });
        Self {
            boxes,
            mesh: Mesh {
                indices: joined.collect(),
                positions,
            },
            parts: meshes,
        }
    }

    pub fn list(&self) -> Vec<&dyn ShadowCaster> {
        self.boxes
            .iter()
            .map(|caster| caster as &dyn ShadowCaster)
            .collect()
    }

    /// Makes the `count` boxes nearest to a position change in every frame, and no others.
    pub fn set_in_motion(&mut self, count: u32, place: Vec3) {
        self.boxes.sort_by(|a, b| {
            let away = |caster: &BoxCaster| caster.bounds.min.distance_squared(place);
            away(a).total_cmp(&away(b))
        });
        for (rank, caster) in (0..).zip(&mut self.boxes) {
            caster.version = (rank >= count).then_some(0);
        }
    }

    /// Returns the bounds of all boxes.
    pub fn bounds(&self) -> Aabb {
        self.mesh.bounds()
    }
}

/// Returns half the side of the ground under `count` boxes.
pub fn half_side(count: u32) -> f32 {
    (count as f32).sqrt()
}

impl ShadowCaster for BoxCaster {
    fn bounds(&self) -> Aabb {
        self.bounds
    }

    fn pipeline(&self) -> &CasterPipeline {
        &self.pipeline
    }

    fn draw(&self, pass: &mut wgpu::RenderPass<'_>, _: &ShadowView) {
        pass.set_vertex_buffer(0, self.vertices.slice(..));
        pass.set_index_buffer(self.indices.slice(..), wgpu::IndexFormat::Uint32);
        pass.draw_indexed(0..self.index_count, self.first_vertex, 0..1);
    }

    fn keeps_pass_state(&self) -> bool {
        true
    }

    fn triangles(&self) -> u32 {
        self.told_triangles
    }

    fn revision(&self) -> Option<Revision> {
        Some(Revision::new(self.id, self.version?))
    }
}
