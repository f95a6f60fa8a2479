//! Provides a ready-made caster: a vertex buffer, an optional index buffer, and a matrix.

use std::sync::OnceLock;

use glam::Mat4;

use crate::cast::instances::{CasterInstances, Instance, append_matrix};
use crate::cast::mesh_check::{MESH, check_bounds, check_buffers, check_matrix};
use crate::cast::mesh_descriptor::{MeshCasterDescriptor, MeshIndices};
use crate::cast::mesh_geometry::MeshGeometry;
use crate::cast::{CasterPipeline, Revision, ShadowCaster};
use crate::error::CasterError;
use crate::fit::CasterShape;
use crate::gpu::filled_buffer;
use crate::{Aabb, ShadowView};

/// Casts the shadow of a mesh with one transform.
///
/// Its [`Revision`] changes when [`set_transform`](Self::set_transform) changes the transform, when
/// [`set_geometry`](Self::set_geometry) replaces the buffers, and when
/// [`geometry_changed`](Self::geometry_changed) is called, so that meshes that do not move keep
/// their maps. Buffers whose contents change without such a call leave a stale shadow behind.
///
/// Meshes that share a pipeline, buffers and a range of indices are drawn in one call for each
/// view, whatever lies between them in the engine's list. For many copies of one mesh,
/// [`InstancedMeshCaster`](crate::InstancedMeshCaster) is one caster, and costs less memory and
/// less of a frame.
#[derive(Debug)]
pub struct MeshCaster {
    geometry: MeshGeometry,
    bounds_model: Aabb,
    instance: Instance,
    shape_model: CasterShape,
    casts: bool,
    receives: bool,
    label: String,
    /// Holds the matrix for [`ShadowCaster::draw`], once that has been called; `None` where the
    /// device could not make the buffer.
    own_matrix: OnceLock<Option<wgpu::Buffer>>,
}

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
        let geometry = MeshGeometry::new(
            &MESH,
            device,
            descriptor.pipeline,
            descriptor.vertices,
            &descriptor.indices,
        )?;
        let instance = checked_instance(
            &geometry,
            &descriptor.bounds_model,
            &descriptor.render_from_model,
            Revision::of_new_mesh(),
        )?;
        Ok(Self {
            geometry,
            bounds_model: descriptor.bounds_model,
            instance,
            shape_model: CasterShape::Any,
            casts: true,
            receives: true,
            label: descriptor.label.unwrap_or("shadow mesh caster").to_owned(),
            own_matrix: OnceLock::new(),
        })
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
    /// submitted: lights copy the matrix into their own buffers in the order of the engine's
    /// commands.
    ///
    /// # Errors
    /// Returns [`CasterError::NotFinite`] for a matrix that is not finite or takes the bounds to
    /// infinity; the mesh stays where it was.
    pub fn set_transform(&mut self, render_from_model: Mat4) -> Result<(), CasterError> {
        check_matrix(&render_from_model)?;
        if self.geometry.matrix_layout().is_none()
            || render_from_model == self.instance.render_from_model
        {
            return Ok(());
        }
        self.change(&self.bounds_model.clone(), &render_from_model)
    }

    /// Returns the transform to render space from model space.
    pub fn render_from_model(&self) -> Mat4 {
        self.instance.render_from_model
    }

    /// Records that the contents of the buffers have changed and sets their new bounds in model
    /// space. Without this call, maps that show the old geometry are kept.
    ///
    /// # Errors
    /// Returns [`CasterError::NotFinite`] for bounds that are neither finite nor empty; the mesh
    /// keeps those that it had.
    pub fn geometry_changed(&mut self, bounds_model: Aabb) -> Result<(), CasterError> {
        self.change(&bounds_model, &self.instance.render_from_model.clone())?;
        self.bounds_model = bounds_model;
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
        check_buffers(&MESH, self.geometry.pipeline(false), vertices, &indices)?;
        self.geometry_changed(bounds_model)?;
        self.geometry.set_buffers(vertices, indices);
        Ok(())
    }

    /// Replaces the instance by one of the next version.
    fn change(&mut self, bounds_model: &Aabb, matrix: &Mat4) -> Result<(), CasterError> {
        let revision = self.instance.revision.next();
        self.instance = checked_instance(&self.geometry, bounds_model, matrix, revision)?;
        self.own_matrix = OnceLock::new();
        Ok(())
    }

    /// Returns a vertex buffer with one instance, for [`ShadowCaster::draw`].
    fn matrix_buffer(&self, layout: (u64, u64)) -> Option<&wgpu::Buffer> {
        let make = || {
            let mut bytes = Vec::new();
            append_matrix(&mut bytes, layout, &self.instance.render_from_model);
            let device = self.geometry.pipeline(false).device();
            filled_buffer(device, &self.label, &bytes, wgpu::BufferUsages::VERTEX).ok()
        };
        self.own_matrix.get_or_init(make).as_ref()
    }
}

/// Makes an instance whose bounds are finite or empty.
fn checked_instance(
    geometry: &MeshGeometry,
    bounds_model: &Aabb,
    render_from_model: &Mat4,
    revision: Revision,
) -> Result<Instance, CasterError> {
    check_bounds(MESH.bounds_model, bounds_model)?;
    let instance = Instance::new(geometry, bounds_model, *render_from_model, revision);
    check_bounds(
        "MeshCasterDescriptor::render_from_model * bounds_model",
        &instance.bounds_render,
    )?;
    Ok(instance)
}

impl ShadowCaster for MeshCaster {
    fn bounds(&self) -> Aabb {
        self.instance.bounds_render
    }

    fn pipeline(&self) -> &CasterPipeline {
        self.geometry.pipeline(self.instance.mirrors)
    }

    /// Draws the mesh by itself. Lights draw it by its [`instances`](ShadowCaster::instances)
    /// instead; only a caster that wraps it and does not return them calls this. Where the device
    /// is lost or out of memory, nothing is drawn.
    fn draw(&self, pass: &mut wgpu::RenderPass<'_>, _view: &ShadowView) {
        if let Some(layout) = self.geometry.matrix_layout() {
            let Some(matrix) = self.matrix_buffer(layout) else {
                return;
            };
            pass.set_vertex_buffer(1, matrix.slice(..));
        }
        self.geometry.bind(pass);
        self.geometry.draw(pass, 0..1);
    }

    fn instances(&self) -> Option<CasterInstances<'_>> {
        Some(CasterInstances {
            geometry: &self.geometry,
            shape_model: self.shape_model,
            instances: std::slice::from_ref(&self.instance),
        })
    }

    fn casts(&self) -> bool {
        self.casts
    }

    fn receives(&self) -> bool {
        self.receives
    }

    fn shape(&self) -> CasterShape {
        match self.geometry.matrix_layout() {
            Some(_) => self
                .shape_model
                .transformed(&self.instance.render_from_model),
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
        self.geometry.triangles()
    }

    fn revision(&self) -> Option<Revision> {
        Some(self.instance.revision)
    }
}
