//! The baseline: the shadow-mapping chapters of learnopengl.com, as they are written there, on the same device.
//!
//! Nothing is tuned, nothing is taken from the library: standard depth, whole scene in one map, the tutorial's own constants
//! in the tutorial's own units, and coordinates in world space.
//!
//! ```text
//! flat.rs    one map: orthographic for a sun, perspective for a spot; bias by slope, mean of 3x3 comparisons
//! cube.rs    distance from a point light in a cube map; 64 or 20 comparisons
//! meshes.rs  vertex buffers and depth passes
//! ```

pub mod cube;
pub mod flat;
pub mod meshes;
