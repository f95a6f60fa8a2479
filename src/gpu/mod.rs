//! Connects the library to a wgpu device. It does not depend on anything about shadows.
//!
//! ```text
//! scope.rs        device errors as values
//! limits.rs       what objects need of a device's limits
//! depth_format.rs DepthFormat: 32 or 16 bits a texel
//! depth_map.rs    a layered depth texture
//! upload.rs       buffers written in command order
//! multiview.rs    which devices draw six faces at once correctly
//! fullscreen.rs   pipelines of passes over a whole viewport
//! ```

mod depth_format;
mod depth_map;
mod fullscreen;
mod limits;
mod multiview;
mod scope;
mod upload;

pub use depth_format::DepthFormat;
pub(crate) use depth_map::{DepthMap, allocated_layers};
pub(crate) use fullscreen::{FullscreenTarget, fullscreen_pipeline};
pub(crate) use limits::Need;
pub(crate) use multiview::{ALL_FACES_MASK, FACE_COUNT, supports_cube_multiview};
pub(crate) use scope::{capture_device_errors, filled_buffer, filled_buffer_of};
pub(crate) use upload::{StagedUploads, Upload, UploadBuffer};
