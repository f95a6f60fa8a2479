//! Loads glTF 2.0 files.
//!
//! ```text
//! load.rs       file to triangles, textures, lights and camera
//! images.rs     its textures, decoded
//! primitive.rs  one glTF primitive to a triangle list
//! scene.rs      a scene once it is loaded
//! ```

mod images;
mod load;
mod primitive;
pub mod scene;

pub use load::{load, load_bytes};
