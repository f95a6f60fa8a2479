//! Renders the depth of casters. It uses the fit and the device, and does not depend on how maps
//! are sampled.
//!
//! ```text
//! caster.rs              ShadowCaster: what the engine implements; revision.rs: its Revision
//! instances.rs           CasterInstances: copies of a mesh, which batches are made of
//! caster_set.rs          CasterSet: casters that stay from frame to frame
//! caster_records.rs      what the methods of casters returned
//! frame_casters.rs       the casters of a frame
//! pipeline_descriptor.rs how a kind of caster is laid out and shaded
//! pipeline.rs            CasterPipeline: the pipelines made of it
//! pipeline_build.rs      the wgpu side of them; cube_pipeline.rs: those for six faces in one pass
//! pipeline_reads.rs      what a vertex stage reads
//! caster_limits.rs       what pipelines and passes need of a device's limits
//! view_uniform.rs        the uniforms of a view in a vertex stage
//! mesh.rs                MeshCaster: a ready-made caster; instanced_mesh.rs: InstancedMeshCaster
//! mesh_descriptor.rs     what they are made of; mesh_check.rs: their checks
//! mesh_geometry.rs       their pipeline and buffers
//! closed.rs              which meshes are closed solids; mesh_shape.rs: which cannot shadow themselves
//! layer_cache.rs         what a layer caches, and what a frame must draw
//! recorder.rs            the passes of a frame; layer_pass.rs: those over the layer of one view;
//!                        shared_layer_pass.rs: those over a layer that views share
//! shared_layer.rs        how parts of a layer are cleared and copied
//! ray_pass.rs            many views of one texel, in one pass
//! draw_list.rs           the draw calls of the passes, one for all instances of equal geometry
//! instance_matrices.rs   the matrices that these draw
//! draw_casters.rs        the loop that makes the draw calls
//! cube_pass.rs           six faces in one pass; cube_rule.rs: when that is cheaper than a pass for each
//! costs.rs               what passes, draws, triangles and copies cost beside each other
//! ```

mod caster;
mod caster_limits;
mod caster_records;
mod caster_set;
mod closed;
mod costs;
mod cube_pass;
mod cube_pipeline;
mod cube_rule;
mod draw_casters;
mod draw_list;
mod frame_casters;
mod instance_matrices;
mod instanced_mesh;
mod instances;
mod layer_cache;
mod layer_pass;
mod mesh;
mod mesh_check;
mod mesh_descriptor;
mod mesh_geometry;
mod mesh_shape;
mod pipeline;
mod pipeline_build;
mod pipeline_descriptor;
mod pipeline_reads;
mod ray_pass;
mod recorder;
mod revision;
mod shared_layer;
mod shared_layer_pass;
mod view_uniform;

pub use caster::ShadowCaster;
pub(crate) use caster_limits::caster_group;
pub(crate) use caster_records::{CasterRecords, CastersVersion};
pub use caster_set::{CasterId, CasterSet, Casters, RetainedCasters};
pub use closed::is_closed_solid;
pub use frame_casters::BrokenBounds;
pub(crate) use frame_casters::{FrameCasters, sound_bounds};
pub use instanced_mesh::InstancedMeshCaster;
pub use instances::CasterInstances;
pub(crate) use layer_cache::{Plan, ViewDraws};
pub use mesh::MeshCaster;
pub use mesh_descriptor::{InstancedMeshCasterDescriptor, MeshCasterDescriptor, MeshIndices};
pub use mesh_shape::caster_shape;
pub use pipeline::CasterPipeline;
pub use pipeline_descriptor::{
    CasterPipelineDescriptor, CasterVertex, ModelTransform, PositionAttribute,
};
pub(crate) use ray_pass::{RayDraws, RayPass};
pub(crate) use recorder::{Recorder, RecorderKind};
pub use revision::Revision;
pub(crate) use shared_layer::shared_layer_group;
pub(crate) use view_uniform::VIEW_UNIFORM_BYTES;

/// Clears a map to the far plane (reversed depth): nothing casts.
const CLEAR: wgpu::LoadOp<f32> = wgpu::LoadOp::Clear(0.0);

/// Returns a depth attachment that stores what is drawn.
fn depth_attachment(
    view: &wgpu::TextureView,
    load: wgpu::LoadOp<f32>,
) -> wgpu::RenderPassDepthStencilAttachment<'_> {
    wgpu::RenderPassDepthStencilAttachment {
        view,
        depth_ops: Some(wgpu::Operations {
            load,
            store: wgpu::StoreOp::Store,
        }),
        stencil_ops: None,
    }
}
