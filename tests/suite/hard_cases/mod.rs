//! Scenes that break shadow maps: each through the whole path, fit, cast, receive and read back.
//!
//! Every case records what it expects and what it measured; `target/hard_cases.md` is the table of the last run.

mod cascades;
mod creases;
mod degenerate;
mod extreme_cameras;
mod far_away;
mod fuzz;
mod fuzz_values;
mod layers;
mod light_axes;
mod long_run;
mod meshes;
mod scales;
mod stage;
mod steady;
mod table;
mod thin_casters;
