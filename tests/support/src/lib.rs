//! Contains what the tests, benches and examples of `wgpu-shadows` share. It is never published.
//!
//! ```text
//! gpu.rs        a device without a window
//! readback.rs   what it computed; clock.rs: how long that took
//! bind.rs       bind groups whose bindings are numbered in order
//! random.rs     the same numbers on every machine
//! mesh.rs       generated meshes, as casters and as triangles; triangle.rs: triangles in f64
//! camera.rs     cameras of every kind, with the rays of their pixels
//! probe.rs      a compute shader that evaluates WGSL at given points
//! scene.rs      meshes, a light and a camera; scenes.rs, deep_scenes.rs: the generated ones
//! truth.rs      the ray caster, checked by closed_form.rs
//! technique.rs  anything that fills maps and is looked up: library.rs, textbook/; what a lookup
//!               costs: lookup_cost.rs
//! compositions/ every shader that the library emits, for checks by compilers
//! measure/      errors and costs of techniques in scenes, as tables and charts
//! ```

pub mod bind;
pub mod camera;
pub mod clock;
pub mod closed_form;
pub mod compositions;
mod deep_scenes;
pub mod gpu;
pub mod library;
pub mod lookup_cost;
pub mod measure;
pub mod mesh;
pub mod probe;
pub mod random;
pub mod readback;
pub mod scene;
pub mod scenes;
pub mod technique;
pub mod textbook;
pub mod triangle;
pub mod truth;
