//! Provides a ready-made caster: a vertex buffer, an optional index buffer, and a matrix.

use std::sync::atomic::{AtomicU64, Ordering};

use glam::Mat4;

use crate::cast::mesh_check::{check_bounds, check_buffers, check_matrix, check_pipeline};
use crate::cast::mesh_descriptor::{MeshCasterDescriptor, MeshIndices};
use crate::cast::{CasterPipeline, ModelTransform, Revision, ShadowCaster};
use crate::error::CasterError;
use crate::error::DeviceError;
use crate::fit::CasterShape;
use crate::gpu::filled_buffer;
use crate::{Aabb, ShadowView};

/// Casts the shadow of a mesh with one transform.
///
/// Its [`Revision`] changes when [`set_transform`](Self::set_transform) changes the transform, when
/// [`set_geometry`](Self::set_geometry) replaces the buffers, and when
/// [`geometry_changed`](Self::geometry_changed) is called, so that meshes that do not move keep
/// their maps. Buffers whose contents change without such a call leave a stale shadow behind.
#[derive(Debug)]
pub struct MeshCaster {
    pipeline: CasterPipeline,
    vertices: wgpu::Buffer,
    indices: MeshIndices,
    bounds_model: Aabb,
    bounds_render: Aabb,
    transform: Option<wgpu::Buffer>,
    render_from_model: Mat4,
    shape_model: CasterShape,
    casts: bool,
    receives: bool,
    label: String,
    id: u64,
    version: u64,
}

static NEXT_ID: AtomicU64 = AtomicU64::new(0);

impl MeshCaster {
    /// Keeps handles of the buffers; only the matrix is copied.
    ///
    /// # Errors
    /// Returns [`CasterError`] for a matrix or bounds that are not finite, a pipeline that takes
    /// more than a mesh sets or belongs to another device, a buffer without its usage flag or of
    /// another device, index and vertex ranges that are empty or not within their buffer, indices
    /// of a format that does not match a strip pipeline, or a device that is lost or out of memory.
    pub fn new(
        device: &wgpu::Device,
        descriptor: &MeshCasterDescriptor<'_>,
    ) -> Result<Self, CasterError> {
        check_matrix(&descriptor.render_from_model)?;
        check_pipeline(device, descriptor.pipeline)?;
        check_buffers(
            descriptor.pipeline,
            descriptor.vertices,
            &descriptor.indices,
        )?;
        let has_matrix = matches!(
            descriptor.pipeline.model_transform(),
            ModelTransform::InstanceMatrix { .. }
        );
        let mut mesh = Self {
            pipeline: descriptor.pipeline.clone(),
            vertices: descriptor.vertices.clone(),
            indices: descriptor.indices.clone(),
            bounds_model: descriptor.bounds_model,
            bounds_render: descriptor.bounds_model,
            transform: None,
            render_from_model: descriptor.render_from_model,
            shape_model: CasterShape::Any,
            casts: true,
            receives: true,
            label: descriptor.label.unwrap_or("shadow mesh caster").to_owned(),
            id: NEXT_ID.fetch_add(1, Ordering::Relaxed),
            version: 0,
        };
        if has_matrix {
            mesh.transform = Some(mesh.transform_buffer(&descriptor.render_from_model)?);
            if mirrors(&descriptor.render_from_model) {
                mesh.pipeline = mesh.pipeline.mirrored();
            }
        }
        mesh.bounds_render = mesh.bounds(&mesh.bounds_model, &mesh.render_from_model)?;
        Ok(mesh)
    }

    /// Sets what is known of the surface in model space;
    /// [`caster_shape`](crate::caster::caster_shape) finds it. The shape of a new mesh is
    /// [`CasterShape::Any`].
    pub fn set_shape(&mut self, shape_model: CasterShape) {
        self.shape_model = shape_model;
    }

    /// Sets whether the mesh casts shadows and whether shadows are looked up on its surface
    /// ([`ShadowCaster::casts`], [`ShadowCaster::receives`]). A new mesh does both.
    pub fn set_roles(&mut self, casts: bool, receives: bool) {
        self.casts = casts;
        self.receives = receives;
    }

    /// Sets the transform to render space from model space. A transform equal to the present one
    /// changes nothing. Without an instance matrix in its pipeline the mesh is in render space
    /// already, and this call has no effect.
    ///
    /// Passes that were recorded before show the mesh where it was then, whenever they are
    /// submitted: the matrix goes into a new buffer, and passes keep the one that they were
    /// recorded with.
    ///
    /// # Errors
    /// Returns [`CasterError::NotFinite`] for a matrix that is not finite or takes the bounds to
    /// infinity, [`CasterError::Device`] for a device that is lost or out of memory; the mesh stays
    /// where it was.
    pub fn set_transform(&mut self, render_from_model: Mat4) -> Result<(), CasterError> {
        check_matrix(&render_from_model)?;
        if self.transform.is_none() || render_from_model == self.render_from_model {
            return Ok(());
        }
        let bounds_render = self.bounds(&self.bounds_model, &render_from_model)?;
        self.transform = Some(self.transform_buffer(&render_from_model)?);
        if mirrors(&render_from_model) != mirrors(&self.render_from_model) {
            self.pipeline = self.pipeline.mirrored();
        }
        self.render_from_model = render_from_model;
        self.bounds_render = bounds_render;
        self.version += 1;
        Ok(())
    }

    /// Returns the transform to render space from model space.
    pub fn render_from_model(&self) -> Mat4 {
        self.render_from_model
    }

    /// Records that the contents of the buffers have changed and sets their new bounds in model
    /// space. Without this call, maps that show the old geometry are kept.
    ///
    /// # Errors
    /// Returns [`CasterError::NotFinite`] for bounds that are neither finite nor empty; the mesh
    /// keeps those that it had.
    pub fn geometry_changed(&mut self, bounds_model: Aabb) -> Result<(), CasterError> {
        self.bounds_render = self.bounds(&bounds_model, &self.render_from_model)?;
        self.bounds_model = bounds_model;
        self.version += 1;
        Ok(())
    }

    /// Replaces the geometry, for an engine whose buffer has grown or that draws another range of
    /// it: `vertices` and `indices` as in [`MeshCasterDescriptor`], and the bounds of what they
    /// draw in model space. Maps that show the old geometry are drawn again. The shape
    /// ([`set_shape`](Self::set_shape)) stays; set it anew if it does not hold for the new
    /// geometry, which otherwise loses shadows on itself.
    ///
    /// Passes that were recorded before draw the old buffers, whenever they are submitted.
    ///
    /// # Errors
    /// Returns [`CasterError`] for bounds that are neither finite nor empty, and for buffers and
    /// ranges that [`MeshCaster::new`] refuses; the mesh keeps those that it had.
    pub fn set_geometry(
        &mut self,
        vertices: &wgpu::Buffer,
        indices: MeshIndices,
        bounds_model: Aabb,
    ) -> Result<(), CasterError> {
        check_buffers(&self.pipeline, vertices, &indices)?;
        self.geometry_changed(bounds_model)?;
        self.vertices = vertices.clone();
        self.indices = indices;
        Ok(())
    }

    /// Returns the bounds in render space that a mesh with `bounds_model` would have under a
    /// transform.
    fn bounds(&self, bounds_model: &Aabb, render_from_model: &Mat4) -> Result<Aabb, CasterError> {
        check_bounds("MeshCasterDescriptor::bounds_model", bounds_model)?;
        if self.transform.is_none() {
            return Ok(*bounds_model);
        }
        let bounds = bounds_model.transformed(render_from_model);
        check_bounds(
            "MeshCasterDescriptor::render_from_model * bounds_model",
            &bounds,
        )?;
        Ok(bounds)
    }

    /// Returns a vertex buffer with one instance that holds the matrix at the offset where the
    /// pipeline reads it.
    fn transform_buffer(&self, render_from_model: &Mat4) -> Result<wgpu::Buffer, CasterError> {
        filled_buffer(
            self.pipeline.device(),
            &self.label,
            &matrix_bytes(&self.pipeline, render_from_model),
            wgpu::BufferUsages::VERTEX,
        )
        .map_err(|refusal| {
            CasterError::Device(DeviceError {
                object: "the transform of a mesh",
                refusal,
            })
        })
    }
}

impl ShadowCaster for MeshCaster {
    fn bounds(&self) -> Aabb {
        self.bounds_render
    }

    fn pipeline(&self) -> &CasterPipeline {
        &self.pipeline
    }

    fn draw(&self, pass: &mut wgpu::RenderPass<'_>, _view: &ShadowView) {
        pass.set_vertex_buffer(0, self.vertices.slice(..));
        if let Some(transform) = &self.transform {
            pass.set_vertex_buffer(1, transform.slice(..));
        }
        match &self.indices {
            MeshIndices::None { vertices } => pass.draw(vertices.clone(), 0..1),
            MeshIndices::Buffer {
                buffer,
                format,
                indices,
                base_vertex,
            } => {
                pass.set_index_buffer(buffer.slice(..), *format);
                pass.draw_indexed(indices.clone(), *base_vertex, 0..1);
            }
        }
    }

    fn casts(&self) -> bool {
        self.casts
    }

    fn receives(&self) -> bool {
        self.receives
    }

    fn shape(&self) -> CasterShape {
        match self.transform {
            Some(_) => self.shape_model.transformed(&self.render_from_model),
            None => self.shape_model,
        }
    }

    fn keeps_pass_state(&self) -> bool {
        true
    }

    fn same_in_every_view(&self) -> bool {
        true
    }

    fn triangles(&self) -> u32 {
        let corners = match &self.indices {
            MeshIndices::None { vertices } => vertices.len(),
            MeshIndices::Buffer { indices, .. } => indices.len(),
        };
        self.pipeline.triangles_of(corners as u32)
    }

    fn revision(&self) -> Option<Revision> {
        Some(Revision::of_mesh(self.id, self.version))
    }
}

/// Returns whether a transform turns a counter-clockwise triangle into a clockwise one.
fn mirrors(render_from_model: &Mat4) -> bool {
    render_from_model.determinant() < 0.0
}

/// Returns the bytes of one instance, with the matrix at the offset where the pipeline reads it.
fn matrix_bytes(pipeline: &CasterPipeline, matrix: &Mat4) -> Vec<u8> {
    let (array_stride, offset) = match pipeline.model_transform() {
        ModelTransform::Identity => (64, 0),
        ModelTransform::InstanceMatrix {
            array_stride,
            offset,
        } => (array_stride as usize, offset as usize),
    };
    let mut bytes = vec![0; array_stride];
    bytes[offset..offset + 64].copy_from_slice(bytemuck::bytes_of(matrix));
    bytes
}
