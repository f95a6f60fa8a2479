//! Defines how a receiver samples a map, and how the engine's shader accesses it.
//!
//! ```text
//! filter.rs        which texels a lookup reads, and their weights
//! bias.rs          how a receiver is kept from shadowing itself
//! check_sampling.rs  the checks of filter and bias
//! uniforms.rs      the layout that Rust and WGSL share; light_uniforms.rs: the values of a light's views
//! reference/       the CPU reference: the WGSL's arithmetic in f64
//! texel_access.rs  gathers, or samples where a device has no gather
//! maps.rs          ShadowMaps: what every light owns; sampled_maps.rs: what a lookup needs of it;
//!                  layer_state.rs: a layer in a frame
//! layer_limits.rs  what the maps of a light need of a device's limits
//! report.rs        ShadowReport: what a light did in a frame
//! bindings.rs      one bind group for a set of lights; layout.rs: the entries of it
//! emit.rs          the WGSL for exactly that set, from the templates that template.rs fills
//! ```

mod bias;
mod bindings;
mod check_sampling;
mod emit;
mod filter;
mod layer_limits;
mod layer_state;
mod layout;
mod light_uniforms;
mod maps;
pub mod reference;
mod report;
mod sampled_maps;
mod template;
mod texel_access;
mod uniforms;

pub use bias::Bias;
pub use bindings::{ShadowBindings, ShadowBindingsDescriptor};
pub(crate) use check_sampling::{check_bias, check_fade, check_filter, check_planar_filter};
pub use filter::Filter;
pub(crate) use layer_state::{ALL_TEXELS, LayerState, NO_LIMIT};
pub use maps::ShadowMaps;
pub(crate) use maps::{MapsFrame, ShadowMapsDescriptor};
pub use report::{ShadowReport, ViewReport, ViewStatus};
pub(crate) use sampled_maps::{SampledMaps, Selection};
pub(crate) use template::ErrorMeterPass;
pub use uniforms::ShadowViewUniform;
pub(crate) use uniforms::{Sampling, view_uniform_bytes};
