//! What the examples that draw pictures share: a small engine without a window.
//!
//! ```text
//! arguments.rs    the command line, and errors in one line
//! gpu.rs          a device without a window, and pictures from it
//! picture.rs      PNG files
//! map_picture.rs  a shadow map as a picture
//! camera.rs       where a scene is looked at from
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
