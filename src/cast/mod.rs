//! First floor: depth renders of what can cast. Knows the fit, and nothing of filters.
//!
//! ```text
//! caster.rs       ShadowCaster and Revision: what the engine implements
//! frame_casters.rs  the casters of a frame, each asked once
//! pipeline.rs     CasterPipeline: how a kind of caster is laid out and shaded
//! pipeline_build.rs  the wgpu side of it
//! pipeline_reads.rs  what its vertex stage reads
//! mesh.rs         MeshCaster: a ready-made caster
//! mesh_check.rs   what it must be made of
//! depth_format.rs DepthFormat: 32 or 16 bits a texel
//! depth_map.rs    the layered depth texture
//! closed.rs       which meshes are closed solids
//! content.rs      what a layer holds, and what a frame must draw
//! recorder.rs     the passes
//! draw_casters.rs the loop that draws casters in them
//! cube_pass.rs    six faces in one pass; cube_pipeline.rs: the pipelines for it
//! cube_rule.rs    when one pass is cheaper than a pass each
//! multiview.rs    which devices draw six views at once, rightly
//! upload.rs       uniform buffers written in command order
//! device_scope.rs device errors as values
//! ```

mod caster;
mod closed;
mod content;
mod cube_pass;
mod cube_pipeline;
mod cube_rule;
mod depth_format;
mod depth_map;
mod device_scope;
mod draw_casters;
mod frame_casters;
mod mesh;
mod mesh_check;
mod multiview;
mod pipeline;
mod pipeline_build;
mod pipeline_reads;
mod recorder;
mod upload;

pub use caster::{Revision, ShadowCaster};
pub use closed::is_closed_solid;
pub(crate) use content::{Plan, ViewDraws};
pub use depth_format::DepthFormat;
pub(crate) use depth_map::{DepthMap, allocated_layers};
pub(crate) use device_scope::{capture_device_errors, filled_buffer};
pub(crate) use frame_casters::{CasterAnswers, FrameCasters};
pub use mesh::{MeshCaster, MeshCasterDescriptor, MeshIndices};
pub use pipeline::{
    CasterPipeline, CasterPipelineDescriptor, CasterVertex, ModelTransform, PositionAttribute,
};
pub(crate) use recorder::{Recorder, VIEW_UNIFORM_BYTES};
pub(crate) use upload::UploadBuffer;

/// Nothing casts (reversed depth).
const CLEAR: wgpu::LoadOp<f32> = wgpu::LoadOp::Clear(0.0);

/// A depth attachment that keeps what is drawn.
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
