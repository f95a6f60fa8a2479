//! First floor: depth renders of what can cast. Knows the fit, and nothing of filters.
//!
//! ```text
//! caster.rs       ShadowCaster and Revision: what the engine implements
//! pipeline.rs     CasterPipeline: how a kind of caster is laid out and shaded
//! pipeline_build.rs  the wgpu side of it
//! mesh.rs         MeshCaster: a ready-made caster
//! depth_map.rs    the layered depth texture
//! recorder.rs     which views need drawing, and the passes
//! upload.rs       uniform buffers written in command order
//! device_scope.rs device errors as values
//! ```

mod caster;
mod depth_map;
mod device_scope;
mod mesh;
mod pipeline;
mod pipeline_build;
mod recorder;
mod upload;

pub use caster::{Revision, ShadowCaster};
pub(crate) use depth_map::DepthMap;
pub(crate) use device_scope::{DeviceRefusal, capture_device_errors};
pub use mesh::{MeshCaster, MeshCasterDescriptor, MeshIndices};
pub use pipeline::{
    CasterPipeline, CasterPipelineDescriptor, CasterVertex, ModelTransform, PositionAttribute,
};
pub(crate) use recorder::{Recorder, ViewDraws};
pub(crate) use upload::UploadBuffer;

/// Format of every depth map: reversed 32-bit depth, whose error is a few ulps anywhere in the range.
pub const DEPTH_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Depth32Float;

/// Clears a depth map to "nothing casts" (reversed: 0) and keeps what is drawn.
fn depth_attachment(view: &wgpu::TextureView) -> wgpu::RenderPassDepthStencilAttachment<'_> {
    wgpu::RenderPassDepthStencilAttachment {
        view,
        depth_ops: Some(wgpu::Operations {
            load: wgpu::LoadOp::Clear(0.0),
            store: wgpu::StoreOp::Store,
        }),
        stencil_ops: None,
    }
}
