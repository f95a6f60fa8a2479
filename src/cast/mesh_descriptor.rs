//! Describes what ready-made mesh casters are made of.

use std::ops::Range;

use glam::Mat4;

use crate::Aabb;
use crate::cast::CasterPipeline;

/// Selects the range of its buffers that a [`MeshCaster`](crate::MeshCaster) or an
/// [`InstancedMeshCaster`](crate::InstancedMeshCaster) draws.
#[derive(Clone, Debug)]
pub enum MeshIndices {
    /// Draws vertices in order.
    None {
        /// Is the range of vertices; not empty, and within the vertex buffer.
        vertices: Range<u32>,
    },
    /// Draws through an index buffer created with `BufferUsages::INDEX`.
    Buffer {
        /// Is the index buffer, made on the same device as the pipeline.
        buffer: wgpu::Buffer,
        /// Is the format of the indices; for a strip pipeline it must be the pipeline's
        /// `strip_index_format`.
        format: wgpu::IndexFormat,
        /// Is the range of indices; not empty, and within the index buffer.
        indices: Range<u32>,
        /// Is added to every index.
        base_vertex: i32,
    },
}

/// Describes what a [`MeshCaster`](crate::MeshCaster) is made of.
/// [`MeshCaster::new`](crate::MeshCaster::new) checks it.
#[derive(Clone, Debug)]
pub struct MeshCasterDescriptor<'a> {
    /// Is the label of the buffer that is made where the mesh is drawn by itself; "shadow mesh
    /// caster" if `None`.
    pub label: wgpu::Label<'a>,
    /// Is a pipeline made on the same device, normally with the built-in vertex stage. Where it
    /// culls and the transform mirrors, its counterpart of the other winding is used. A pipeline
    /// with the engine's own vertex stage is accepted if it takes no more than vertex buffer 0 and
    /// no bind group of its own.
    pub pipeline: &'a CasterPipeline,
    /// Holds vertices in the layout of the pipeline; created with `BufferUsages::VERTEX`.
    pub vertices: &'a wgpu::Buffer,
    /// Selects what to draw.
    pub indices: MeshIndices,
    /// Bounds the drawn vertices in model space: finite, or empty for a mesh that casts nothing.
    /// Geometry outside its bounds loses its shadow at times.
    pub bounds_model: Aabb,
    /// Is the transform to render space from model space: affine and finite, and with entries that
    /// take the bounds to finite ones.
    pub render_from_model: Mat4,
}

/// Describes what an [`InstancedMeshCaster`](crate::InstancedMeshCaster) is made of.
/// [`InstancedMeshCaster::new`](crate::InstancedMeshCaster::new) checks it.
#[derive(Clone, Debug)]
pub struct InstancedMeshCasterDescriptor<'a> {
    /// Is the label of the buffer that is made where the caster is drawn by itself; "shadow
    /// instances" if `None`.
    pub label: wgpu::Label<'a>,
    /// Is a pipeline made on the same device, with the built-in vertex stage and an instance
    /// matrix. Where it culls, its counterpart of the other winding draws the instances whose
    /// transform mirrors.
    pub pipeline: &'a CasterPipeline,
    /// Holds the vertices of one copy in the layout of the pipeline; created with
    /// `BufferUsages::VERTEX`.
    pub vertices: &'a wgpu::Buffer,
    /// Selects what to draw of them for each copy.
    pub indices: MeshIndices,
    /// Bounds the drawn vertices in model space: finite, or empty for a mesh that casts nothing.
    /// Geometry outside its bounds loses its shadow at times, each copy where its own bounds are
    /// culled.
    pub bounds_model: Aabb,
    /// Holds one transform to render space from model space for each copy, affine and with entries
    /// that take the bounds to finite ones. A copy with another transform has no shadow, and
    /// [`ShadowFrame::broken_bounds`](crate::ShadowFrame::broken_bounds) names it in each frame.
    /// The list may be empty.
    pub render_from_model: &'a [Mat4],
}
