//! What the fit of a local light starts from.

use glam::DVec3;

use crate::Aabb;
use crate::fit::axes::LightAxes;
use crate::fit::region::HalfSpaces;

/// What a frame brings.
pub(crate) struct LocalInput<'a> {
    pub origin: DVec3,
    pub position_world: DVec3,
    /// World units; may be infinite.
    pub range: f64,
    /// Axes of each view: it looks against its z axis.
    pub views: &'a [LightAxes],
    /// Tangent of half the angle over which a view has receivers.
    pub receiver_tangent: f64,
    /// The same for casters: wider by what a kernel at the border reaches.
    pub caster_tangent: f64,
    /// Lookups reach beyond the place of their receiver: views are not limited to where receivers are seen.
    pub looks_around: bool,
    /// Receivers count where they lie in one of these regions: what the cameras see, or everywhere.
    pub seen: &'a [HalfSpaces],
    /// Bounds of what casts; empty ones cast nothing.
    pub casters: &'a [Aabb],
    /// Bounds of what receives.
    pub receivers: &'a [Aabb],
    pub map_size: u32,
    pub margin_texels: u32,
}
