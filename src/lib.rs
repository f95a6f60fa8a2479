//! Shadow mapping for any wgpu engine.

#![warn(missing_docs)]
#![forbid(unsafe_code)]

mod aabb;
mod cast;
mod check;
mod debug_view;
mod directional;
mod error;
mod fit;
mod receive;
mod report;
pub mod shader;

pub use aabb::Aabb;
pub use cast::{
    CasterPipeline, CasterPipelineDescriptor, CasterVertex, DEPTH_FORMAT, MeshCaster,
    MeshCasterDescriptor, MeshIndices, ModelTransform, PositionAttribute, Revision, ShadowCaster,
};
pub use debug_view::DebugView;
pub use directional::{
    Coverage, DirectionalFrame, DirectionalLight, DirectionalShadow, DirectionalShadowDescriptor,
};
pub use error::{BindingsError, CasterError, DebugViewError, ShadowError};
pub use fit::{CameraView, CascadeSplit, LightAxes, ShadowView};
pub use receive::{
    Bias, Filter, ShadowBindings, ShadowBindingsDescriptor, ShadowSource, ShadowViewUniform,
    reference,
};
pub use report::{ShadowReport, ViewReport, ViewStatus};
