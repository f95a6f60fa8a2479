//! Defines instances of meshes: what ready-made casters consist of, and what is drawn in batches.

use glam::Mat4;

use crate::Aabb;
use crate::cast::Revision;
use crate::cast::mesh_geometry::MeshGeometry;
use crate::fit::CasterShape;

/// Is one copy of a mesh.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Instance {
    pub render_from_model: Mat4,
    /// Bounds the copy in render space. The bounds are broken where the matrix is not finite.
    pub bounds_render: Aabb,
    pub revision: Revision,
    /// States that the transform turns a counter-clockwise triangle into a clockwise one.
    pub mirrors: bool,
}

impl Instance {
    /// Makes an instance of a mesh with `bounds_model`. Where the pipeline of the geometry reads
    /// no matrix, the mesh is in render space already, and the matrix has no effect.
    pub(crate) fn new(
        geometry: &MeshGeometry,
        bounds_model: &Aabb,
        render_from_model: Mat4,
        revision: Revision,
    ) -> Self {
        let is_moved = geometry.matrix_layout().is_some();
        let bounds_render = if bounds_model.is_empty() || !is_moved {
            *bounds_model
        } else if !render_from_model.is_finite() {
            Aabb::BROKEN
        } else {
            bounds_model.transformed(&render_from_model)
        };
        Self {
            render_from_model,
            bounds_render,
            revision,
            mirrors: is_moved && render_from_model.determinant() < 0.0,
        }
    }
}

/// Holds the copies of a mesh that a ready-made caster consists of.
///
/// [`ShadowCaster::instances`](crate::ShadowCaster::instances) returns it. Each copy is fitted,
/// culled and kept by itself, and all copies in a view that share a pipeline, buffers and a range
/// of indices are drawn in one call, whichever casters they belong to.
#[derive(Clone, Copy, Debug)]
pub struct CasterInstances<'a> {
    pub(crate) geometry: &'a MeshGeometry,
    pub(crate) shape_model: CasterShape,
    pub(crate) instances: &'a [Instance],
}

impl CasterInstances<'_> {
    /// Returns the number of copies.
    pub fn len(&self) -> usize {
        self.instances.len()
    }

    /// Returns whether there are no copies.
    pub fn is_empty(&self) -> bool {
        self.instances.is_empty()
    }
}

/// Writes one instance of a layout to the end of `bytes`: `array_stride` bytes with the matrix at
/// `offset`.
pub(crate) fn append_matrix(
    bytes: &mut Vec<u8>,
    (array_stride, offset): (u64, u64),
    matrix: &Mat4,
) {
    let start = bytes.len();
    if (array_stride, offset) != (64, 0) {
        bytes.resize(start + array_stride as usize, 0);
        bytes[start + offset as usize..][..64].copy_from_slice(bytemuck::bytes_of(matrix));
    } else {
        bytes.extend_from_slice(bytemuck::bytes_of(matrix));
    }
}
