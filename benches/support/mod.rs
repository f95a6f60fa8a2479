//! Measures shadows: contains scenes, the truth about them, techniques with their settings, their costs and their
//! errors.
//!
//! ```text
//! scene.rs          what is measured; scenes.rs: the generated ones; mesh.rs, camera.rs
//! truth.rs          the ray caster, checked by closed_form.rs
//! pixels.rs         what a camera sees, with the truth; edge.rs: how far it is from a shadow's edge
//! technique.rs      what is compared: library.rs, textbook/
//! configuration.rs  the settings
//! measure.rs        runs the techniques; probe.rs: samples and times; error.rs: compares; floor.rs: the least error of a filter
//! overall.rs        means over scenes, and the judgement; pareto.rs
//! report.rs         tables; chart.rs: charts; picture.rs: truth and results side by side
//! gpu.rs, parallel.rs, random.rs, statistics.rs
//! ```

#![allow(dead_code, reason = "each bench, example and test uses a part of it")]

pub mod camera;
pub mod chart;
pub mod closed_form;
pub mod configuration;
pub mod edge;
pub mod error;
pub mod floor;
pub mod gpu;
pub mod library;
pub mod measure;
pub mod mesh;
pub mod overall;
pub mod parallel;
pub mod pareto;
pub mod picture;
pub mod pixels;
pub mod probe;
pub mod random;
pub mod report;
pub mod scene;
pub mod scenes;
pub mod statistics;
pub mod technique;
pub mod textbook;
pub mod truth;
