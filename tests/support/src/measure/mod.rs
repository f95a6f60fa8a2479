//! Measures techniques in scenes: their costs, and their errors against the truth.
//!
//! ```text
//! configuration.rs  the settings
//! pixels.rs         what a camera sees, with the truth; edge.rs: the distance to a shadow's edge
//! subject.rs        runs the techniques in one scene; prober.rs: samples and times
//! error.rs          compares with the truth; floor.rs: the least error of a filter
//! overall.rs        means over scenes, and the judgement; pareto.rs
//! report.rs         tables; chart.rs: charts; picture.rs: truth and results side by side
//! parallel.rs, statistics.rs
//! ```

pub mod chart;
pub mod configuration;
pub mod edge;
pub mod error;
pub mod floor;
pub mod overall;
pub mod parallel;
pub mod pareto;
pub mod picture;
pub mod pixels;
pub mod prober;
pub mod report;
pub mod statistics;
pub mod subject;
