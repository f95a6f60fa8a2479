//! Tests scenes that break shadow maps, each from the fit to the visibilities read back.
//!
//! Every case compares what it expects and what it measured with the table in `doc/hard_cases.md`.

mod borders;
mod cascades;
mod creases;
mod degenerate;
mod depth_steps;
mod endless_lamps;
mod extreme_cameras;
mod far_away;
mod far_lamps;
mod fuzz;
mod fuzz_bindings;
mod fuzz_casters;
mod fuzz_grounds;
mod fuzz_pools;
mod fuzz_reference;
mod fuzz_untidy;
mod fuzz_untidy_lamps;
mod fuzz_values;
mod giant_grounds;
mod grounds;
mod layers;
mod light_axes;
mod long_run;
mod meshes;
mod moving_casters;
mod near_lights;
mod near_plane;
mod scales;
mod seam_edges;
mod stage;
mod steady;
mod thin_casters;
mod wall_foot;

use crate::fixtures::table;
