//! Shadow mapping for engines that are built on [`wgpu`]: an engine passes in its lights, its
//! camera and what casts shadows, and gets depth maps, a bind group, and WGSL functions that return
//! visibility with a bias that needs no tuning.
//!
//! ![Three cubes and their shadows][picture-quickstart]
//!
//! The crate creates no device, submits nothing, and does not shade. It requires no optional device
//! feature.
//!
//! # Usage
//!
//! ```no_run
//! use wgpu_shadows::glam::{DVec3, Vec3};
//! use wgpu_shadows::*;
//!
//! struct Shadows {
//!     scene: ShadowScene, // shared by all lights
//!     sun: DirectionalShadow,
//!     bindings: ShadowBindings,
//! }
//!
//! impl Shadows {
//!     /// At load time.
//!     fn new(device: &wgpu::Device) -> Result<Self, Box<dyn std::error::Error>> {
//!         let sun = DirectionalShadow::new(device, &DirectionalShadowDescriptor::default())?;
//!         let lights = [("sun", sun.maps())];
//!         let descriptor = ShadowBindingsDescriptor { group: 1, lights: &lights, ..Default::default() };
//!         let bindings = ShadowBindings::new(device, &descriptor)?;
//!         Ok(Self { scene: ShadowScene::new(), sun, bindings })
//!     }
//!
//!     /// In every frame, before the pass that shades.
//!     fn record(
//!         &mut self,
//!         encoder: &mut wgpu::CommandEncoder,
//!         camera: CameraView,
//!         casters: &[&dyn ShadowCaster],
//!     ) -> Result<(), ShadowError> {
//!         let cameras = [camera];
//!         let coverage = Coverage::Cameras(&cameras);
//!         let frame = ShadowFrameDescriptor {
//!             origin: DVec3::ZERO,
//!             coverage,
//!             casters: Casters::List(casters),
//!             receivers: &[],
//!         };
//!         let light = DirectionalLight::new(Vec3::new(0.4, -0.8, 0.2));
//!         self.sun.record(encoder, &self.scene.frame(&frame)?, &light)?;
//!         Ok(())
//!     }
//! }
//! ```
//!
//! The engine puts [`ShadowBindings::wgsl`] in front of its own shader, [`ShadowBindings::layout`]
//! into its pipeline layout at the index `group`, and sets [`ShadowBindings::bind_group`] there
//! while it shades. Its fragment shader then calls
//!
//! ```wgsl
//! let normal = shadow_geometric_normal(position, camera_position - position);
//! let visibility = shadow_sun(position, normal);
//! ```
//!
//! What casts implements [`ShadowCaster`], or is a [`MeshCaster`]. `examples/quickstart.rs` in the
//! repository is a complete program.
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
//! depth texture    the cascades of a sun, the map of a spot light, six faces of a point light
//!    │  receive    bind group and WGSL: your fragment shader calls shadow_NAME(position, normal)
//!    ▼
//! your image       and a ShadowReport
//! ```
//!
//! The lights themselves ([`DirectionalShadow`], [`SpotShadow`], [`OmniShadow`] and the pools)
//! connect these stages. `ARCHITECTURE.md` in the repository follows a light's direction and a
//! caster's bounds through them, file by file.
//!
//! Everything is recorded into the engine's encoder in order: first the uniforms, then the depth
//! passes. The encoder must be submitted before any work that samples the shadows. Several frames
//! may be recorded before one submission; each of them shows its own state.
//!
//! # Which light
//!
//! | light | type | depth maps |
//! |---|---|---|
//! | the sun, the moon | [`DirectionalShadow`] | 1 to 8 cascades |
//! | a spot light | [`SpotShadow`] | one |
//! | a point light, or a spot light wider than [`SpotLight::WIDEST_SENSIBLE_OUTER_ANGLE`] | [`OmniShadow`] | six faces of a cube |
//! | many spot or point lights, which come and go | [`pool::SpotShadowPool`], [`pool::OmniShadowPool`] | one layer for all, divided by what the cameras see, with a budget of views per frame |
//!
//! All lights of a frame are recorded with the same [`ShadowFrame`]. A sun over a scene as deep as
//! it is wide needs one cascade; a view to the horizon needs three or four. By default the library
//! finds how many, where they end, and how many texels of one map each gets; an engine that knows
//! better gives them ([`CascadeLayout`]). [`DirectionalShadowDescriptor::blend`] hides where one
//! ends. [`ShadowMaps::report`] tells how fine the maps of the last frame are, how large an error
//! is expected, and what was drawn; [`debug::DebugView`] draws the maps.
//!
//! # A list of casters or a set
//!
//! [`ShadowFrameDescriptor::casters`] is a [`Casters`]. With [`Casters::List`] the engine collects
//! its casters for each frame; the methods of all of them are called, and each light tests all of
//! their bounds. That is the simplest way, and the cheapest for scenes of up to some hundred
//! casters.
//!
//! With [`Casters::Set`] the engine keeps its casters in a [`CasterSet`], inserts and removes them,
//! and says by [`CasterSet::update`] which of them changed. A tree finds those that a light needs,
//! so that a frame costs what changed and what is seen: thousands of casters, of which most stand
//! still or are out of sight, belong in a set. The price is what can be forgotten: a caster that
//! moves without an `update` leaves its shadow behind, where a list would have noticed. Since
//! bounds are in render space, an engine whose `origin` follows the camera has to update all
//! casters whenever the origin moves; it moves the origin rarely, or uses a list.
//!
//! Both give the same maps, bit for bit. The order of casters means nothing, neither that of a list
//! nor that in which a set was filled: a view is kept while the revisions of its casters are the
//! same. Where cameras and lights are those of the frame before, a light does nothing at all unless
//! some caster has changed within its reach: where it lights what is seen, or for a directional
//! light between that and the light. That holds for up to 4096 changes in a frame, and while no
//! caster is without a [`ShadowCaster::revision`].
//!
//! # Which filter and bias
//!
//! The defaults, [`Filter::Tent3`] with a sharpness of 3 and [`Bias::Auto`], suit most scenes.
//! [`DirectionalShadowDescriptor::CHEAP`] and [`DirectionalShadowDescriptor::ACCURATE`] trade error
//! for cost. [`Filter::Pcss`] renders the penumbrae of a light of a given size. [`Filter`] lists
//! the cost and the reach of each filter, and `cargo run --release --example tune -- FILE.glb`
//! measures them in a scene of your own.
//!
//! [`Bias::Auto`] has nothing to tune. Over a plane, ndc depth is affine in map coordinates, for
//! orthographic and perspective views alike, so the shader transforms the receiver's tangent plane
//! to texel space, gathers raw depths, and compares each of them with the depth of the plane at
//! that texel, clamped so that it never lies farther from the light than the receiver. What remains
//! is an offset for rounding, and one of a tenth of a texel. [`Bias::NormalOffset`] and
//! [`Bias::Manual`] are the usual methods, for comparison and for engines whose images must not
//! change.
//!
//! The normal must be the geometric one, of unit length, on the side that is shaded;
//! `shadow_geometric_normal(position, toward_viewer)` computes it from screen-space derivatives.
//! `toward_viewer` selects the side. Derivatives alone cannot, since a projection that mirrors (a
//! planar reflection, a target whose y points down, a captured cube map) reverses them. It is any
//! vector from the surface to the side that is looked at, of any length but zero:
//! `camera_position - position` for a perspective camera, the reverse of the view direction for an
//! orthographic one. An interpolated shading normal also works, but fails at silhouettes, where it
//! points behind the facet. A normal on the wrong side pushes receivers into their own surface,
//! which shows as acne everywhere.
//!
//! Derivatives of rounded positions are rounded: at coordinate `P` and distance `d` from the
//! camera, in an image of 1000 pixels a radian, that normal errs by up to `5·10⁻⁴ P / d` radians.
//! From some `P` = 100 `d` on, let [`ShadowFrameDescriptor::origin`] follow the camera, or pass a
//! normal that the mesh has for its triangles.
//!
//! # What a kept map relies on
//!
//! A view keeps its map while its light, its fit and its casters do not change. A light knows what
//! it has recorded, but not what the device has executed. A kept map is therefore stale where
//!
//! - an encoder was dropped, or its `finish` failed because some command in it was invalid, a
//!   caster's own commands included;
//! - encoders were submitted in another order than they were recorded in;
//! - the encoder belongs to another device than the light (wgpu reports this only when the encoder
//!   is finished);
//! - other code wrote to the texture or to the uniform buffer;
//! - a caster's [`Revision`] stayed the same while what it draws changed.
//!
//! After any of these but the last, call the light's `invalidate`: the next frame then draws
//! everything. A caster that panics while it draws needs no such call; the layer that it was being
//! drawn into is drawn again in the next frame.
//!
//! The engine's `origin` may move without a new revision. A kept map then carries the rounding of
//! the render coordinates from which it was drawn, and the bias allows for that rounding. The map
//! is drawn again where the rounding exceeds both twice that of a new map and 1/64 of a texel.
//!
//! [`choosing`] helps to choose a light, a filter and a budget. [`engines`] tells how engines of
//! different shapes take the library in: those that give hooks only, that keep objects in a hash
//! map, whose buffers grow, that draw mirrors, that shade in compute shaders. [`troubleshooting`]
//! tells what faults look like, what causes them and what to do. [`hard_cases`] lists scenes and
//! inputs that break shadow maps, with what the crate promises for each and what was measured.
//! [`glossary`] explains the terms of the field, with formulas and sources.
//!
//! # Own bind groups
//!
//! An engine that has no index left for [`ShadowBindings`] binds [`ShadowMaps::texture_view`] and
//! [`ShadowMaps::uniform_buffer`] in a group of its own. [`shader::compose`] returns the WGSL of
//! the modules that it names and of all that they require, and their functions take texture,
//! sampler and view as arguments:
//!
//! ```
//! let wgsl = wgpu_shadows::shader::compose(&["bias_plane", "filter_tent3"])?;
//! let engine = "
//!     @group(0) @binding(4) var sun_map: texture_depth_2d_array;
//!     @group(0) @binding(5) var map_sampler: sampler; // wgpu::SamplerDescriptor::default()
//!     @group(0) @binding(6) var<uniform> sun_views: array<ShadowViewUniform, 1>;
//!
//!     fn sunlight(position: vec3<f32>, normal: vec3<f32>) -> f32 {
//!         let receiver = shadow_receiver_plane_directional(sun_views[0], position, normal);
//!         if !receiver.inside {
//!             return 1.0;
//!         }
//!         let visibility = shadow_filter_tent3(sun_map, map_sampler, receiver);
//!         return shadow_limited_by_depth(sun_views[0], position, visibility);
//!     }";
//! # naga::front::wgsl::parse_str(&(wgsl.clone() + engine)).expect("valid WGSL");
//! let shader = wgsl + engine;
//! # Ok::<(), wgpu_shadows::error::BindingsError>(())
//! ```
//!
//! The last call ends the shadows of a directional light. Without it [`CameraView::max_distance`]
//! and [`DirectionalShadowDescriptor::fade`] have no effect: shadows then end where the maps end,
//! raggedly and in places far beyond the distance. A spot or point light with a `fade` calls
//! `shadow_limited_by_distance(view, position, visibility)` in its place; one without a `fade`
//! needs neither, because `receiver.inside` is false beyond its range.
//!
//! `examples/own_layout.rs` in the repository does this for a sun and a point light.
//! [`ShadowViewUniform`] is the Rust side of the uniforms. The function of [`Filter::Hardware`]
//! takes a `sampler_comparison` instead, which is linear and compares by `GreaterEqual`. The
//! [`shader`] module tells what changes on devices that cannot gather.
//!
//! # Cameras relative to an origin
//!
//! | space | definition | type |
//! |---|---|---|
//! | world | absolute coordinates, in metres or any other unit | f64 |
//! | render | world minus the frame's `origin` (zero by default): what the engine's shaders use | f32 |
//! | light | x right, y up, looking along -z, in the same unit | f64, internal |
//! | clip, ndc | as WebGPU defines it: z in \[0, 1\], y up; depth is reversed: near 1, far 0 | f32 |
//! | texel | origin at the top left, texel centres at halves | f32 |
//!
//! An engine that renders relative to its camera sets [`ShadowFrameDescriptor::origin`] to the
//! world position that is zero in its shaders. The matrices of a [`CameraView`], the bounds of
//! casters and receivers, and the positions that shaders pass in are in render space; the positions
//! of lights are in world space. A map is kept while the origin moves.
//!
//! Without an origin, f32 coordinates far from zero bring their own rounding into the shadows:
//! shadows of a scene at distance `P` are displaced by up to `P` / 2 000 000 (half a millimetre at
//! 1 km, five centimetres at 100 km), and the bias grows by as much.
//!
//! Matrices are named `target_from_source`; scalars carry their unit in their name.
//!
//! # What is promised under semver
//!
//! Everything public follows semantic versioning, with [`wgpu`] and [`glam`] as part of the
//! interface: a new major version of either is a breaking change here. The same holds for these
//! names of the WGSL, with their parameters and their meaning:
//!
//! - of [`ShadowBindings::wgsl`]: `shadow_NAME`, `shadow_view_NAME`, `shadow_map_NAME` and
//!   `shadow_views_NAME` for each light, and `shadow_geometric_normal`;
//! - of [`shader::MODULES`]: the names of the modules `view`, `cube_face`, `normal`,
//!   `texels_by_offsets`, `texels_by_samples`, `bias_*`, and `filter_*` except `filter_direction`;
//!   of their functions `shadow_view_holds`, `shadow_limited_by_depth`,
//!   `shadow_limited_by_distance`, `shadow_cube_face`, `shadow_geometric_normal`,
//!   `shadow_receiver_NAME_directional` and `shadow_receiver_NAME_local` of a module `bias_NAME`,
//!   and `shadow_filter_NAME` of a module `filter_NAME`; and of their structs `ShadowReceiver` with
//!   the member `inside` and `ShadowViewUniform` with the member `anchor`;
//! - in the text of a [`caster::CasterVertex::Wgsl`]: `shadow_caster_clip`.
//!
//! All names that the WGSL declares begin with `shadow_`, `Shadow` or `SHADOW_`, so an engine's own
//! names are safe if they do not. Everything else in the WGSL may change with any version: texts,
//! other names, other members, the size and the layout of [`ShadowViewUniform`], and the numbers of
//! bindings. So may the last digits of a visibility.

#![cfg_attr(doc, doc = include_str!("../doc/pictures.md"))]
#![warn(missing_docs, unreachable_pub)]
#![forbid(unsafe_code)]

mod aabb;
mod cast;
mod check;
pub mod debug;
pub mod error;
mod fit;
mod gpu;
mod light;
pub mod meter;
mod receive;
pub mod shader;

pub use aabb::Aabb;
pub use cast::{
    CasterId, CasterPipeline, CasterSet, Casters, InstancedMeshCaster, MeshCaster, Revision,
    ShadowCaster,
};
pub use error::ShadowError;
pub use fit::{CameraView, CascadeLayout, CascadeSplit, ShadowView, Stability};
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

/// Contains what casters are made of: the layout and shading of their vertices, and a ready-made
/// mesh.
pub mod caster {
    pub use crate::cast::{
        CasterInstances, CasterPipelineDescriptor, CasterVertex, InstancedMeshCasterDescriptor,
        MeshCasterDescriptor, MeshIndices, ModelTransform, PositionAttribute, RetainedCasters,
        caster_shape, is_closed_solid,
    };
    pub use crate::fit::CasterShape;
}

/// Contains pools of spot and point lights: many lights in one texture, looked up by index.
pub mod pool {
    pub use crate::light::{OmniShadowPool, PoolDescriptor, PoolLight, ShadowSlot, SpotShadowPool};
}

/// Contains reports of what lights did in a frame and how fine their maps are.
pub mod report {
    pub use crate::cast::BrokenBounds;
    pub use crate::fit::{SliceReport, TexelRect};
    pub use crate::receive::{ShadowReport, ViewReport, ViewStatus};
}

#[cfg(doc)]
#[doc = include_str!("../doc/choosing.md")]
pub mod choosing {}

#[cfg(doc)]
#[doc = include_str!("../doc/engines.md")]
pub mod engines {}

#[cfg(doc)]
#[doc = include_str!("../doc/hard_cases.md")]
pub mod hard_cases {}

#[cfg(doc)]
#[doc = include_str!("../doc/troubleshooting.md")]
#[doc = include_str!("../doc/pictures.md")]
pub mod troubleshooting {}

#[cfg(doc)]
#[doc = include_str!("../doc/glossary.md")]
pub mod glossary {}

/// Compiles the code of the README.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
