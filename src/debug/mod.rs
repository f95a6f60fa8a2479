//! A room beside the stairs: pictures for people, of what the maps of a light hold and of which view serves a pixel.
//!
//! ```text
//! view.rs         DebugView: layers and unfolded cubes as grey levels
//! cascade_tint.rs the engine's image tinted by the view that serves each pixel
//! limits.rs       what they need of a device's limits
//! ```

mod cascade_tint;
mod limits;
mod view;

pub use view::{DebugImage, DebugView};
