//! Compares pools, which divide their texels by what the camera sees, with lights that have equal
//! maps, in scenes of many lamps.
//!
//! ```text
//! scenes.rs   a hall of 32 point lights, and a street of 200 spot lights
//! contest.rs  errors over all lamps against rays, at several numbers of bytes
//! ```

mod contest;
mod scenes;

pub use contest::measure;
pub use scenes::all;
