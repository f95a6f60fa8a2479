//! Contains what the examples that draw images share: a small engine without a window.
//!
//! ```text
//! arguments.rs    the command line, and errors in one line
//! gpu.rs          a device without a window, and images from it
//! picture.rs      PNG files
//! map_picture.rs  a shadow map as an image
//! camera.rs       the camera of a scene
//! mesh.rs         boxes, squares and spheres
//! phong.rs        the pass that draws them
//! phong.wgsl      its vertex stage and Blinn-Phong
//! ```

#![allow(dead_code, reason = "each example uses a part of it")]

pub mod arguments;
pub mod camera;
pub mod gpu;
pub mod map_picture;
pub mod mesh;
pub mod phong;
pub mod picture;
