//! What a ready-made mesh is made of.

use std::ops::Range;

use glam::Mat4;

use crate::Aabb;
use crate::cast::CasterPipeline;

/// What of its buffers a [`MeshCaster`](crate::MeshCaster) draws.
#[derive(Clone, Debug)]
pub enum MeshIndices {
    /// Vertices in order.
    None {
        /// Range of vertices.
        vertices: Range<u32>,
    },
    /// Through an index buffer created with `BufferUsages::INDEX`.
    Buffer {
        /// The buffer.
        buffer: wgpu::Buffer,
        /// Its format.
        format: wgpu::IndexFormat,
        /// Range of indices.
        indices: Range<u32>,
        /// Added to every index.
        base_vertex: i32,
    },
}

/// What a [`MeshCaster`](crate::MeshCaster) is made of.
#[derive(Clone, Debug)]
pub struct MeshCasterDescriptor<'a> {
    /// Label of the transform buffer.
    pub label: wgpu::Label<'a>,
    /// A pipeline with the built-in vertex stage, made on the same device. Where it culls and the transform mirrors, its
    /// mirrored twin is used. One with the engine's own vertex stage will do if it takes no more than vertex buffer 0 and no
    /// bind group of its own.
    pub pipeline: &'a CasterPipeline,
    /// Vertices laid out as the pipeline says, created with `BufferUsages::VERTEX`.
    pub vertices: &'a wgpu::Buffer,
    /// What to draw.
    pub indices: MeshIndices,
    /// Bounds of the drawn vertices in model space: finite, or empty for a mesh that casts nothing.
    pub bounds_model: Aabb,
    /// Render space from model space: affine and finite, and so small that it takes the bounds to finite ones.
    pub render_from_model: Mat4,
}
