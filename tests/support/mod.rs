//! Contains what several tests share: a device, small scenes with their truth, and probes that sample the library's
//! lights.

pub mod ask;
pub mod camera;
pub mod child;
pub mod cube_pair;
pub mod figures;
pub mod floor;
pub mod frames;
pub mod golden;
pub mod gpu;
pub mod lamp_scenes;
pub mod lights;
pub mod local_truth;
pub mod multiview;
pub mod picture;
pub mod probe;
pub mod random;
pub mod random_scene;
pub mod readback;
pub mod report;
pub mod rounding;
pub mod scene;
pub mod table;
pub mod texture_bytes;
pub mod triangles;
pub mod view_member;
pub mod watched;
pub mod wgsl;
pub mod wgsl_operators;
