//! Holds the geometry of ready-made casters: a pipeline and the buffers that it draws.

use std::hash::{DefaultHasher, Hash, Hasher};
use std::ops::Range;

use crate::cast::mesh_check::{MeshFields, check_buffers, check_pipeline};
use crate::cast::mesh_descriptor::MeshIndices;
use crate::cast::{CasterPipeline, ModelTransform};
use crate::error::CasterError;

/// Is a pipeline with the buffers and the range that it draws. Meshes of equal geometry are drawn
/// in one call.
#[derive(Debug)]
pub(crate) struct MeshGeometry {
    /// Holds the pipeline as given, and the one for transforms that mirror.
    pipelines: [CasterPipeline; 2],
    vertices: wgpu::Buffer,
    indices: MeshIndices,
    /// Orders geometries so that those of the same buffers lie side by side, and among them those
    /// of the same range. Different geometries have the same key where hashes collide.
    sort_key: u64,
}

impl MeshGeometry {
    /// Checks a pipeline and buffers of `device`, and keeps handles of them. `fields` are their
    /// paths, for errors.
    pub(crate) fn new(
        fields: &MeshFields,
        device: &wgpu::Device,
        pipeline: &CasterPipeline,
        vertices: &wgpu::Buffer,
        indices: &MeshIndices,
    ) -> Result<Self, CasterError> {
        check_pipeline(fields, device, pipeline)?;
        check_buffers(fields, pipeline, vertices, indices)?;
        Ok(Self {
            pipelines: [pipeline.clone(), pipeline.mirrored()],
            vertices: vertices.clone(),
            sort_key: sort_key(vertices, indices),
            indices: indices.clone(),
        })
    }

    /// Replaces the buffers and the range by others that have been checked.
    pub(crate) fn set_buffers(&mut self, vertices: &wgpu::Buffer, indices: MeshIndices) {
        self.vertices = vertices.clone();
        self.sort_key = sort_key(vertices, &indices);
        self.indices = indices;
    }

    /// Returns the pipeline for transforms that mirror, or the one for all others.
    pub(crate) fn pipeline(&self, mirrored: bool) -> &CasterPipeline {
        &self.pipelines[usize::from(mirrored)]
    }

    pub(crate) fn sort_key(&self) -> u64 {
        self.sort_key
    }

    /// Returns the stride of an instance in vertex buffer 1 and the offset of its matrix, both in
    /// bytes. Returns `None` where vertices are in render space already.
    pub(crate) fn matrix_layout(&self) -> Option<(u64, u64)> {
        match self.pipelines[0].model_transform() {
            ModelTransform::Identity => None,
            ModelTransform::InstanceMatrix {
                array_stride,
                offset,
            } => Some((array_stride, offset)),
        }
    }

    /// Returns the number of triangles of one instance.
    pub(crate) fn triangles(&self) -> u32 {
        let corners = match &self.indices {
            MeshIndices::None { vertices } => vertices.len(),
            MeshIndices::Buffer { indices, .. } => indices.len(),
        };
        self.pipelines[0].triangles_of(corners as u32)
    }

    /// Returns whether both draw the same triangles: one call then draws instances of both.
    pub(crate) fn draws_the_same(&self, other: &Self) -> bool {
        std::ptr::eq(self, other)
            || self.shares_buffers(other) && range(&self.indices) == range(&other.indices)
    }

    /// Returns whether [`Self::bind`] binds the same for both.
    pub(crate) fn shares_buffers(&self, other: &Self) -> bool {
        self.vertices == other.vertices
            && index_buffer(&self.indices) == index_buffer(&other.indices)
    }

    /// Sets vertex buffer 0, and the index buffer if there is one.
    pub(crate) fn bind(&self, pass: &mut wgpu::RenderPass<'_>) {
        pass.set_vertex_buffer(0, self.vertices.slice(..));
        if let MeshIndices::Buffer { buffer, format, .. } = &self.indices {
            pass.set_index_buffer(buffer.slice(..), *format);
        }
    }

    /// Draws instances, with all buffers set.
    pub(crate) fn draw(&self, pass: &mut wgpu::RenderPass<'_>, instances: Range<u32>) {
        match &self.indices {
            MeshIndices::None { vertices } => pass.draw(vertices.clone(), instances),
            MeshIndices::Buffer {
                indices,
                base_vertex,
                ..
            } => pass.draw_indexed(indices.clone(), *base_vertex, instances),
        }
    }
}

fn index_buffer(indices: &MeshIndices) -> Option<(&wgpu::Buffer, wgpu::IndexFormat)> {
    match indices {
        MeshIndices::None { .. } => None,
        MeshIndices::Buffer { buffer, format, .. } => Some((buffer, *format)),
    }
}

/// Returns the first and last index or vertex, and what is added to each.
fn range(indices: &MeshIndices) -> (u32, u32, i32) {
    match indices {
        MeshIndices::None { vertices } => (vertices.start, vertices.end, 0),
        MeshIndices::Buffer {
            indices,
            base_vertex,
            ..
        } => (indices.start, indices.end, *base_vertex),
    }
}

/// Puts a hash of the buffers above one of the range.
fn sort_key(vertices: &wgpu::Buffer, indices: &MeshIndices) -> u64 {
    let hash = |value: &dyn Fn(&mut DefaultHasher)| {
        let mut hasher = DefaultHasher::new();
        value(&mut hasher);
        hasher.finish()
    };
    let buffers = hash(&|hasher| (vertices, index_buffer(indices)).hash(hasher));
    let range = hash(&|hasher| range(indices).hash(hasher));
    buffers << 32 | range & 0xffff_ffff
}
