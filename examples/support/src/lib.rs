//! Contains what the examples share: a small engine without a window, and a loader of glTF files.
//! It is never published.
//!
//! ```text
//! arguments.rs    the command line, and errors in one line
//! camera.rs       the camera of a scene
//! mesh.rs         boxes, squares and spheres
//! phong.rs        the pass that draws them; phong.wgsl: its vertex stage and Blinn-Phong
//! picture.rs      PNG files
//! map_picture.rs  a shadow map as an image
//! image_error.rs  the visibility in an image against cast rays
//! keeping.rs      kept maps against maps that are drawn in every frame
//! textbook.rs     the scene of the classic tutorial
//! town/           a town of some thousand buildings
//! hall/           a hall with a sun, spots and lamps
//! gltf_file/      a glTF file as triangles, textures, lights and a camera
//! ```
//!
//! The device, and what is read back from it, are those of `shadow-support`.

pub mod arguments;
pub mod camera;
pub mod gltf_file;
pub mod hall;
pub mod image_error;
pub mod keeping;
pub mod map_picture;
pub mod mesh;
pub mod phong;
pub mod picture;
pub mod textbook;
pub mod town;
