//! Contains the lights that an engine records and the scene that they share. They connect the fit,
//! the depth passes and the lookups.
//!
//! ```text
//! scene.rs        ShadowScene and ShadowFrame: the input of a frame for all lights
//! directional.rs  DirectionalShadow: the sun
//! spot.rs         SpotShadow: a light that shines into a cone
//! omni.rs         OmniShadow: a light that shines in every direction
//! pool.rs         pools of spot and point lights
//! local.rs        what spot and point lights have in common
//! local_candidate.rs  the fit of one of them, and what would refresh it
//! local_budget.rs     which of them are refreshed under a budget
//! local_sizes.rs      how large the views of a pool's lights are
//! pool_layer.rs       which texels they have
//! distance_limit.rs   where shadows end
//! large_triangles.rs  the rounding that large triangles bring
//! ```

mod directional;
mod distance_limit;
mod large_triangles;
mod local;
mod local_budget;
mod local_candidate;
mod local_sizes;
mod omni;
mod pool;
mod pool_layer;
mod scene;
mod spot;

pub use directional::{DirectionalLight, DirectionalShadow, DirectionalShadowDescriptor};
pub use omni::{OmniLight, OmniShadow, OmniShadowDescriptor};
pub use pool::{OmniShadowPool, PoolDescriptor, PoolLight, ShadowSlot, SpotShadowPool};
pub use scene::{Coverage, ShadowFrame, ShadowFrameDescriptor, ShadowScene};
pub use spot::{SpotLight, SpotShadow, SpotShadowDescriptor};
