#![doc = include_str!("../README.md")]
//!
//! # A frame
//!
//! ```text
//! light + cameras + caster bounds
//!    │  fit        finds what each view covers and which casters reach it: f64 mathematics without wgpu
//!    ▼
//! ShadowView[]     one depth render each: matrices, texel size, depth range
//!    │  cast       decides what is kept, copied or drawn, and records the depth passes
//!    ▼
//! depth texture    layers: cascades of a sun, the map of a spot, six faces of a point light
//!    │  receive    bind group and WGSL: your fragment shader calls shadow_NAME(position, normal)
//!    ▼
//! your image       and a ShadowReport
//! ```
//!
//! The lights themselves ([`DirectionalShadow`], [`SpotShadow`], [`OmniShadow`] and the pools) wire these floors together.
//! `ARCHITECTURE.md` in the repository follows a light's direction and a caster's bounds through them, file by file.
//!
//! Everything is recorded into your encoder, in order: uniforms first, then depth passes. The encoder must be submitted before
//! what asks for the shadows. Several frames may be recorded before one submission: each shows its own state.
//!
//! # What a kept map relies on
//!
//! A view whose light, fit and casters did not change keeps its map. A light knows what it has recorded, not what the device
//! has done with it, so a kept map is stale where
//!
//! - an encoder was dropped, or its `finish` failed because some command in it was invalid, a caster's own commands included;
//! - encoders were submitted in another order than they were recorded in;
//! - the encoder belongs to another device than the light (wgpu tells of it only when the encoder is finished);
//! - something else wrote to the texture or the uniform buffer;
//! - a caster's [`Revision`] stood still while what it draws changed.
//!
//! After any but the last, call the light's `invalidate`: the next frame then draws everything. A caster that panics while it
//! draws needs no call; the layer that it was drawn into is drawn anew by itself.
//!
//! The engine's `origin` may move without a new revision. A kept map then carries the rounding of the render coordinates that
//! it was drawn from; the bias allows for it, and the map is drawn anew where a new one would be more than twice as fine and
//! the difference comes to more than 1/64 of a texel.
//!
//! What may be expected of scenes and inputs that break shadow maps, and what was measured of each: [`hard_cases`].
//!
//! # Spaces
//!
//! | space | what | type |
//! |---|---|---|
//! | world | absolute, metres or any unit | f64 |
//! | render | world minus your `origin` (zero by default): what your shaders see | f32 |
//! | light | x right, y up, looking along -z, same unit | f64, inside |
//! | clip, ndc | WebGPU's: z in \[0, 1\], y up; depth is reversed: near 1, far 0 | f32 |
//! | texel | origin top left, centres at halves | f32 |
//!
//! Without an origin, f32 coordinates far from zero bring their own rounding along: shadows of a scene `P` away are displaced by
//! up to `P` / 2 000 000 (half a millimetre at 1 km, five centimetres at 100 km), and the bias gives way by as much.
//!
//! Matrices are named `target_from_source`; scalars carry their unit.
//!
//! # Bias
//!
//! Ndc depth is affine in map coordinates over a plane, for orthographic and perspective views alike. With [`Bias::Auto`] the
//! shader carries the receiver's tangent plane into texel space, gathers raw depths and compares each with the plane's own depth
//! at that texel, clamped so that it never lies farther from the light than the receiver. What is left is rounding: see
//! [`Bias`]. The normal must be the geometric one, of unit length, on the side that is shaded;
//! `shadow_geometric_normal(position, toward_viewer)` makes it from derivatives.
//!
//! `toward_viewer` tells the side, which derivatives cannot: under a projection that mirrors (a planar reflection, a target with y
//! downward, a captured cube) they turn around. It is any vector from the surface to the side that is looked at, of any length
//! but zero: `camera_position - position` for a perspective camera, the reverse of the direction of view for an orthographic
//! one. An interpolated shading normal will do too, but errs at silhouettes, where it leans behind the facet. A normal on the
//! wrong side pushes receivers into their own surface, which shows as acne all over.

#![warn(missing_docs)]
#![forbid(unsafe_code)]

mod aabb;
mod cast;
mod check;
pub mod debug;
pub mod error;
mod fit;
mod gpu;
mod light;
mod receive;
pub mod shader;

pub use aabb::Aabb;
pub use cast::{CasterPipeline, MeshCaster, Revision, ShadowCaster};
pub use error::ShadowError;
pub use fit::{CameraView, CascadeSplit, ShadowView, Stability};
pub use gpu::DepthFormat;
pub use light::{
    Coverage, DirectionalLight, DirectionalShadow, DirectionalShadowDescriptor, OmniLight,
    OmniShadow, OmniShadowDescriptor, ShadowFrame, ShadowFrameDescriptor, ShadowScene, SpotLight,
    SpotShadow, SpotShadowDescriptor,
};
pub use receive::{
    Bias, Filter, ShadowBindings, ShadowBindingsDescriptor, ShadowMaps, ShadowViewUniform,
    reference,
};
pub use {glam, wgpu};

/// What casters are made of: how their vertices are laid out and shaded, and the ready-made mesh.
pub mod caster {
    pub use crate::cast::{
        CasterPipelineDescriptor, CasterVertex, MeshCasterDescriptor, MeshIndices, ModelTransform,
        PositionAttribute, caster_shape, is_closed_solid,
    };
    pub use crate::fit::CasterShape;
}

/// Pools of spot and point lights: many lights in one texture array, looked up by index.
pub mod pool {
    pub use crate::light::{OmniShadowPool, PoolDescriptor, PoolLight, ShadowSlot, SpotShadowPool};
}

/// What lights did in a frame, and how fine their maps are.
pub mod report {
    pub use crate::cast::BrokenBounds;
    pub use crate::fit::SliceReport;
    pub use crate::receive::{ShadowReport, ViewReport, ViewStatus};
}

#[cfg(doc)]
#[doc = include_str!("../doc/hard_cases.md")]
pub mod hard_cases {}
