//! Draws images for debugging: the contents of a light's maps, and which view covers each pixel. No
//! light depends on this module.
//!
//! ```text
//! view.rs         DebugView: layers and unfolded cubes as grey levels
//! cascade_tint.rs the engine's image, tinted by the view that covers each pixel
//! limits.rs       what a debug view needs of a device's limits
//! ```

mod cascade_tint;
mod limits;
mod view;

pub use view::{DebugImage, DebugView};
