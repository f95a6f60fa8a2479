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
mod light_maps;
mod local_light;
mod omni;
mod receive;
mod report;
pub mod shader;
mod spot;

pub use aabb::Aabb;
pub use cast::{
    CasterPipeline, CasterPipelineDescriptor, CasterVertex, DEPTH_FORMAT, MeshCaster,
    MeshCasterDescriptor, MeshIndices, ModelTransform, PositionAttribute, Revision, ShadowCaster,
};
pub use debug_view::{DebugPicture, DebugView};
pub use directional::{
    Coverage, DirectionalFrame, DirectionalLight, DirectionalShadow, DirectionalShadowDescriptor,
};
pub use error::{BindingsError, CasterError, DebugViewError, ShadowError};
pub use fit::{CameraView, CascadeSplit, LightAxes, ShadowView};
pub use omni::{OmniFrame, OmniLight, OmniShadow, OmniShadowDescriptor};
pub use receive::{
    Bias, Filter, ShadowBindings, ShadowBindingsDescriptor, ShadowSource, ShadowViewUniform,
    reference,
};
pub use report::{ShadowReport, ViewReport, ViewStatus};
pub use spot::{SpotFrame, SpotLight, SpotShadow, SpotShadowDescriptor};
