//! Implements the baseline: the shadow-mapping chapters of learnopengl.com, as they are written
//! there, on the same device.
//!
//! Nothing is tuned, and nothing is taken from the library: depth is standard, one map covers the
//! whole scene, the constants are the tutorial's own in its own units, and coordinates are in world
//! space.
//!
//! ```text
//! flat.rs    one map: orthographic for a sun, perspective for a spot light; bias by slope, mean of 3x3 comparisons
//! cube.rs    distance from a point light in a cube map; 64 or 20 comparisons
//! meshes.rs  vertex buffers and depth passes
//! ```

pub mod cube;
pub mod flat;
pub mod meshes;
