//! Provides a ready-made caster of many copies of one mesh.

use std::ops::Range;
use std::sync::OnceLock;

use glam::Mat4;

use crate::cast::instances::{CasterInstances, Instance, append_matrix};
use crate::cast::mesh_check::{INSTANCED_MESH, check_bounds, check_buffers};
use crate::cast::mesh_descriptor::{InstancedMeshCasterDescriptor, MeshIndices};
use crate::cast::mesh_geometry::MeshGeometry;
use crate::cast::{CasterPipeline, Revision, ShadowCaster};
use crate::error::CasterError;
use crate::fit::CasterShape;
use crate::gpu::filled_buffer;
use crate::{Aabb, ShadowView};

/// Casts the shadows of many copies of one mesh, each with a transform of its own.
///
/// Each copy is fitted, culled and kept by itself, as if it were a
/// [`MeshCaster`](crate::MeshCaster): a view in which no copy changed keeps its map, and a view
/// that sees ten of ten thousand draws ten. The copies that a view sees are drawn in one call. A
/// change of some transforms costs what they are, not what the caster holds.
///
/// ```
/// use wgpu_shadows::caster::{InstancedMeshCasterDescriptor, MeshIndices};
/// use wgpu_shadows::{Aabb, CasterPipeline, InstancedMeshCaster, error::CasterError};
/// use wgpu_shadows::{glam::Mat4, wgpu};
///
/// /// Makes a forest of one tree, whose vertices need no indices.
/// fn forest(
///     device: &wgpu::Device,
///     pipeline: &CasterPipeline,
///     (tree, vertex_count, bounds_model): (&wgpu::Buffer, u32, Aabb),
///     render_from_model: &[Mat4],
/// ) -> Result<InstancedMeshCaster, CasterError> {
///     let descriptor = InstancedMeshCasterDescriptor {
///         label: Some("forest"),
///         pipeline,
///         vertices: tree,
///         indices: MeshIndices::None { vertices: 0..vertex_count },
///         bounds_model,
///         render_from_model,
///     };
///     InstancedMeshCaster::new(device, &descriptor)
/// }
///
/// /// Lets one tree of it sway.
/// fn sway(forest: &mut InstancedMeshCaster, index: usize, to: Mat4) -> Result<(), CasterError> {
///     forest.set_transforms(index, &[to])
/// }
/// ```
///
/// For matrices that only the device knows, and for copies that differ in more than a matrix, an
/// engine implements [`ShadowCaster`] itself and draws from a buffer of its own.
#[derive(Debug)]
pub struct InstancedMeshCaster {
    geometry: MeshGeometry,
    bounds_model: Aabb,
    instances: Vec<Instance>,
    shape_model: CasterShape,
    casts: bool,
    receives: bool,
    label: String,
    /// Is the revision of all instances together.
    revision: Revision,
    /// Holds the matrices for [`ShadowCaster::draw`], once that has been called; `None` where there
    /// are none or the device could not make the buffer.
    own_matrices: OnceLock<Option<wgpu::Buffer>>,
}

impl InstancedMeshCaster {
    /// Keeps handles of the buffers; only the matrices are copied.
    ///
    /// # Errors
    /// Returns [`CasterError`] for all that [`MeshCaster::new`](crate::MeshCaster::new) refuses but
    /// the matrices, and also for a pipeline that reads no instance matrix
    /// ([`CasterError::NoInstanceMatrix`]) and for more instances than fit the device's
    /// `max_buffer_size` ([`CasterError::OverDeviceLimit`]; 4 194 304 of 64 bytes under wgpu's
    /// default limits).
    pub fn new(
        device: &wgpu::Device,
        descriptor: &InstancedMeshCasterDescriptor<'_>,
    ) -> Result<Self, CasterError> {
        let fields = &INSTANCED_MESH;
        check_bounds(fields.bounds_model, &descriptor.bounds_model)?;
        let geometry = MeshGeometry::new(
            fields,
            device,
            descriptor.pipeline,
            descriptor.vertices,
            &descriptor.indices,
        )?;
        if geometry.matrix_layout().is_none() {
            return Err(CasterError::NoInstanceMatrix {
                field: fields.pipeline,
            });
        }
        let mut caster = Self {
            geometry,
            bounds_model: descriptor.bounds_model,
            instances: Vec::new(),
            shape_model: CasterShape::Any,
            casts: true,
            receives: true,
            label: descriptor.label.unwrap_or("shadow instances").to_owned(),
            revision: Revision::of_new_mesh(),
            own_matrices: OnceLock::new(),
        };
        caster.add(
            "InstancedMeshCasterDescriptor::render_from_model",
            descriptor.render_from_model,
        )?;
        Ok(caster)
    }

    /// Sets what is known of the surface of each copy in model space;
    /// [`caster_shape`](crate::caster::caster_shape) finds it. The shape of a new caster is
    /// [`CasterShape::Any`].
    pub fn set_shape(&mut self, shape_model: CasterShape) {
        self.shape_model = shape_model;
    }

    /// Sets whether the copies cast shadows and whether shadows are looked up on their surfaces
    /// ([`ShadowCaster::casts`], [`ShadowCaster::receives`]). Those of a new caster do both.
    pub fn set_roles(&mut self, casts: bool, receives: bool) {
        self.casts = casts;
        self.receives = receives;
    }

    /// Returns the number of copies.
    pub fn len(&self) -> usize {
        self.instances.len()
    }

    /// Returns whether there are no copies.
    pub fn is_empty(&self) -> bool {
        self.instances.is_empty()
    }

    /// Returns the transform of a copy to render space from model space.
    pub fn transform(&self, index: usize) -> Option<&Mat4> {
        let instance = self.instances.get(index)?;
        Some(&instance.render_from_model)
    }

    /// Sets the transforms of copies from `first` on. A transform equal to the present one changes
    /// nothing. A copy whose transform is not finite has no shadow until it has another one, and
    /// [`ShadowFrame::broken_bounds`](crate::ShadowFrame::broken_bounds) names it in each frame.
    ///
    /// Passes that were recorded before show the copies where they were then, whenever they are
    /// submitted.
    ///
    /// # Errors
    /// Returns [`CasterError::NoSuchInstance`] if there are fewer copies, and changes nothing.
    pub fn set_transforms(
        &mut self,
        first: usize,
        render_from_model: &[Mat4],
    ) -> Result<(), CasterError> {
        let end = first.saturating_add(render_from_model.len());
        let range = self.checked_range("first", first..end)?;
        let mut changed = false;
        for (instance, matrix) in self.instances[range].iter_mut().zip(render_from_model) {
            if instance.render_from_model != *matrix {
                let revision = instance.revision.next();
                *instance = Instance::new(&self.geometry, &self.bounds_model, *matrix, revision);
                changed = true;
            }
        }
        if changed {
            self.count_change();
        }
        Ok(())
    }

    /// Adds copies behind the others.
    ///
    /// # Errors
    /// Returns [`CasterError::OverDeviceLimit`] where the matrices of all copies would exceed the
    /// device's `max_buffer_size`, and adds none.
    pub fn push(&mut self, render_from_model: &[Mat4]) -> Result<(), CasterError> {
        self.add("render_from_model", render_from_model)?;
        self.count_change();
        Ok(())
    }

    /// Removes a copy. The last copy takes its index, which is the cheapest way for all others to
    /// keep theirs.
    ///
    /// # Errors
    /// Returns [`CasterError::NoSuchInstance`] if there is no copy at `index`.
    pub fn swap_remove(&mut self, index: usize) -> Result<(), CasterError> {
        let range = self.checked_range("index", index..index.saturating_add(1))?;
        self.instances.swap_remove(range.start);
        self.count_change();
        Ok(())
    }

    /// Removes all copies.
    pub fn clear(&mut self) {
        self.instances.clear();
        self.count_change();
    }

    /// Records that the contents of the buffers have changed and sets the new bounds of a copy in
    /// model space. Without this call, maps that show the old geometry are kept.
    ///
    /// # Errors
    /// Returns [`CasterError::NotFinite`] for bounds that are neither finite nor empty; the caster
    /// keeps those that it had.
    pub fn geometry_changed(&mut self, bounds_model: Aabb) -> Result<(), CasterError> {
        check_bounds(INSTANCED_MESH.bounds_model, &bounds_model)?;
        self.bounds_model = bounds_model;
        for instance in &mut self.instances {
            let (matrix, revision) = (instance.render_from_model, instance.revision.next());
            *instance = Instance::new(&self.geometry, &bounds_model, matrix, revision);
        }
        self.count_change();
        Ok(())
    }

    /// Replaces the mesh of all copies, as
    /// [`MeshCaster::set_geometry`](crate::MeshCaster::set_geometry) does. The shape
    /// ([`set_shape`](Self::set_shape)) stays; set it anew if it does not hold for the new mesh.
    ///
    /// # Errors
    /// Returns [`CasterError`] for bounds that are neither finite nor empty, and for buffers and
    /// ranges that [`InstancedMeshCaster::new`] refuses; the caster keeps those that it had.
    pub fn set_geometry(
        &mut self,
        vertices: &wgpu::Buffer,
        indices: MeshIndices,
        bounds_model: Aabb,
    ) -> Result<(), CasterError> {
        let pipeline = self.geometry.pipeline(false);
        check_buffers(&INSTANCED_MESH, pipeline, vertices, &indices)?;
        self.geometry_changed(bounds_model)?;
        self.geometry.set_buffers(vertices, indices);
        Ok(())
    }

    fn add(&mut self, field: &'static str, matrices: &[Mat4]) -> Result<(), CasterError> {
        let (stride, _) = self.geometry.matrix_layout().unwrap_or_default();
        let count = self.instances.len() as u64 + matrices.len() as u64;
        let device = self.geometry.pipeline(false).device();
        let maximum = device.limits().max_buffer_size;
        let value = count.saturating_mul(stride);
        if value > maximum || count > u64::from(u32::MAX) {
            return Err(CasterError::OverDeviceLimit {
                field,
                limit: "max_buffer_size",
                maximum,
                value,
            });
        }
        let (geometry, bounds_model) = (&self.geometry, &self.bounds_model);
        let new = matrices.iter();
        let new = new.map(|m| Instance::new(geometry, bounds_model, *m, Revision::of_new_mesh()));
        self.instances.extend(new);
        Ok(())
    }

    fn checked_range(
        &self,
        field: &'static str,
        range: Range<usize>,
    ) -> Result<Range<usize>, CasterError> {
        let count = self.instances.len();
        if range.start <= count && range.end <= count {
            return Ok(range);
        }
        Err(CasterError::NoSuchInstance {
            field,
            start: range.start,
            end: range.end,
            count,
        })
    }

    fn count_change(&mut self) {
        self.revision = self.revision.next();
        self.own_matrices = OnceLock::new();
    }

    /// Returns the instances that the caster draws by itself.
    fn drawn_by_itself(&self) -> impl Iterator<Item = &Instance> {
        let sound = |instance: &&Instance| instance.bounds_render.is_finite();
        self.instances.iter().filter(sound)
    }
}

impl ShadowCaster for InstancedMeshCaster {
    fn bounds(&self) -> Aabb {
        let bounds = self
            .drawn_by_itself()
            .map(|instance| instance.bounds_render);
        bounds.fold(Aabb::EMPTY, Aabb::union)
    }

    fn pipeline(&self) -> &CasterPipeline {
        self.geometry.pipeline(false)
    }

    /// Draws all copies, whatever the view sees. Lights draw those that a view sees by the
    /// caster's [`instances`](ShadowCaster::instances) instead; only a caster that wraps it and
    /// does not return them calls this. The copies whose transform mirrors are then drawn with the
    /// winding of the others. Where the device is lost or out of memory, nothing is drawn.
    fn draw(&self, pass: &mut wgpu::RenderPass<'_>, _view: &ShadowView) {
        let layout = self.geometry.matrix_layout().unwrap_or_default();
        let make = || {
            let mut bytes = Vec::new();
            for instance in self.drawn_by_itself() {
                append_matrix(&mut bytes, layout, &instance.render_from_model);
            }
            let device = self.geometry.pipeline(false).device();
            let usage = wgpu::BufferUsages::VERTEX;
            (!bytes.is_empty())
                .then(|| filled_buffer(device, &self.label, &bytes, usage).ok())
                .flatten()
        };
        if let Some(matrices) = self.own_matrices.get_or_init(make) {
            pass.set_vertex_buffer(1, matrices.slice(..));
            self.geometry.bind(pass);
            self.geometry
                .draw(pass, 0..(matrices.size() / layout.0) as u32);
        }
    }

    fn instances(&self) -> Option<CasterInstances<'_>> {
        Some(CasterInstances {
            geometry: &self.geometry,
            shape_model: self.shape_model,
            instances: &self.instances,
        })
    }

    fn casts(&self) -> bool {
        self.casts
    }

    fn receives(&self) -> bool {
        self.receives
    }

    fn keeps_pass_state(&self) -> bool {
        true
    }

    fn same_in_every_view(&self) -> bool {
        true
    }

    fn triangles(&self) -> u32 {
        let copies = self.drawn_by_itself().count() as u32;
        self.geometry.triangles().saturating_mul(copies)
    }

    fn revision(&self) -> Option<Revision> {
        Some(self.revision)
    }
}
