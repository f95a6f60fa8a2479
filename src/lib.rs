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
//! depth texture    layers: cascades of a sun, the map of a spot light, six faces of a point light
//!    │  receive    bind group and WGSL: your fragment shader calls shadow_NAME(position, normal)
//!    ▼
//! your image       and a ShadowReport
//! ```
//!
//! The lights themselves ([`DirectionalShadow`], [`SpotShadow`], [`OmniShadow`] and the pools) connect these stages.
//! `ARCHITECTURE.md` in the repository follows a light's direction and a caster's bounds through them, file by file.
//!
//! Everything is recorded into the engine's encoder in order: first the uniforms, then the depth passes. The encoder
//! must be submitted before any work that samples the shadows. Several frames may be recorded before one submission;
//! each of them shows its own state.
//!
//! # What a kept map relies on
//!
//! A view keeps its map while its light, its fit and its casters do not change. A light knows what it has recorded, but
//! not what the device has executed. A kept map is therefore stale where
//!
//! - an encoder was dropped, or its `finish` failed because some command in it was invalid, a caster's own commands
//!   included;
//! - encoders were submitted in another order than they were recorded in;
//! - the encoder belongs to another device than the light (wgpu reports this only when the encoder is finished);
//! - other code wrote to the texture or to the uniform buffer;
//! - a caster's [`Revision`] stayed the same while what it draws changed.
//!
//! After any of these but the last, call the light's `invalidate`: the next frame then draws everything. A caster that
//! panics while it draws needs no such call; the layer that it was being drawn into is drawn again in the next frame.
//!
//! The engine's `origin` may move without a new revision. A kept map then carries the rounding of the render
//! coordinates from which it was drawn, and the bias allows for that rounding. The map is drawn again where the
//! rounding exceeds both twice that of a new map and 1/64 of a texel.
//!
//! [`hard_cases`] lists scenes and inputs that break shadow maps, with what the crate promises for each and what was
//! measured.
//!
//! # Spaces
//!
//! | space | definition | type |
//! |---|---|---|
//! | world | absolute coordinates, in metres or any other unit | f64 |
//! | render | world minus the frame's `origin` (zero by default): what the engine's shaders use | f32 |
//! | light | x right, y up, looking along -z, in the same unit | f64, internal |
//! | clip, ndc | as WebGPU defines it: z in \[0, 1\], y up; depth is reversed: near 1, far 0 | f32 |
//! | texel | origin at the top left, texel centres at halves | f32 |
//!
//! Without an origin, f32 coordinates far from zero bring their own rounding into the shadows: shadows of a scene at
//! distance `P` are displaced by up to `P` / 2 000 000 (half a millimetre at 1 km, five centimetres at 100 km), and the
//! bias grows by as much.
//!
//! Matrices are named `target_from_source`; scalars carry their unit in their name.
//!
//! # Bias
//!
//! Over a plane, ndc depth is affine in map coordinates, for orthographic and perspective views alike. With
//! [`Bias::Auto`] the shader transforms the receiver's tangent plane to texel space, gathers raw depths, and compares
//! each of them with the depth of the plane at that texel, clamped so that it never lies farther from the light than
//! the receiver. What remains is an offset for rounding, and one of a tenth of a texel; see [`Bias`]. The normal must
//! be the geometric one, of unit length, on the side that is shaded; `shadow_geometric_normal(position, toward_viewer)`
//! computes it from screen-space derivatives.
//!
//! `toward_viewer` selects the side. Derivatives alone cannot, since a projection that mirrors (a planar reflection, a
//! target whose y points down, a captured cube map) reverses them. It is any vector from the surface to the side that
//! is looked at, of any length but zero: `camera_position - position` for a perspective camera, the reverse of the view
//! direction for an orthographic one. An interpolated shading normal also works, but fails at silhouettes, where it
//! points behind the facet. A normal on the wrong side pushes receivers into their own surface, which shows as acne
//! everywhere.

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

/// Contains what casters are made of: the layout and shading of their vertices, and a ready-made mesh.
pub mod caster {
    pub use crate::cast::{
        CasterPipelineDescriptor, CasterVertex, MeshCasterDescriptor, MeshIndices, ModelTransform,
        PositionAttribute, is_closed_solid,
    };
}

/// Contains pools of spot and point lights: many lights in one texture array, looked up by index.
pub mod pool {
    pub use crate::light::{OmniShadowPool, PoolDescriptor, PoolLight, ShadowSlot, SpotShadowPool};
}

/// Contains reports of what lights did in a frame and how fine their maps are.
pub mod report {
    pub use crate::fit::SliceReport;
    pub use crate::receive::{ShadowReport, ViewReport, ViewStatus};
}

#[cfg(doc)]
#[doc = include_str!("../doc/hard_cases.md")]
pub mod hard_cases {}
