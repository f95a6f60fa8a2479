//! Renders the depth of casters. It uses the fit and the device, and does not depend on how maps
//! are sampled.
//!
//! ```text
//! caster.rs              ShadowCaster and Revision: what the engine implements
//! caster_set.rs          CasterSet: casters that stay from frame to frame
//! caster_answers.rs      what the methods of casters returned
//! frame_casters.rs       the casters of a frame
//! pipeline_descriptor.rs how a kind of caster is laid out and shaded
//! pipeline.rs            CasterPipeline: the pipelines made of it
//! pipeline_build.rs      the wgpu side of them; cube_pipeline.rs: those for six faces in one pass
//! pipeline_reads.rs      what a vertex stage reads
//! caster_limits.rs       what pipelines and passes need of a device's limits
//! view_uniform.rs        the uniforms of a view in a vertex stage
//! mesh.rs                MeshCaster: a ready-made caster; mesh_descriptor.rs, mesh_check.rs: its descriptor and checks
//! closed.rs              which meshes are closed solids; mesh_shape.rs: which cannot shadow themselves
//! layer_cache.rs         what a layer caches, and what a frame must draw
//! recorder.rs            the passes; rect_clear.rs: how a part of a layer is cleared
//! draw_casters.rs        the loop that draws casters in them
//! cube_pass.rs           six faces in one pass; cube_rule.rs: when that is cheaper than a pass for each
//! ```

mod caster;
mod caster_answers;
mod caster_limits;
mod caster_set;
mod closed;
mod cube_pass;
mod cube_pipeline;
mod cube_rule;
mod draw_casters;
mod frame_casters;
mod layer_cache;
mod mesh;
mod mesh_check;
mod mesh_descriptor;
mod mesh_shape;
mod pipeline;
mod pipeline_build;
mod pipeline_descriptor;
mod pipeline_reads;
mod recorder;
mod rect_clear;
mod view_uniform;

pub use caster::{Revision, ShadowCaster};
pub(crate) use caster_answers::{CasterAnswers, Content};
pub(crate) use caster_limits::caster_group;
pub use caster_set::{CasterId, CasterSet, Casters, RetainedCasters};
pub use closed::is_closed_solid;
pub use frame_casters::BrokenBounds;
pub(crate) use frame_casters::{FrameCasters, sound_bounds};
pub(crate) use layer_cache::{Plan, ViewDraws};
pub use mesh::MeshCaster;
pub use mesh_descriptor::{MeshCasterDescriptor, MeshIndices};
pub use mesh_shape::caster_shape;
pub use pipeline::CasterPipeline;
pub use pipeline_descriptor::{
    CasterPipelineDescriptor, CasterVertex, ModelTransform, PositionAttribute,
};
pub(crate) use recorder::{Recorder, RecorderKind};
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
