//! Defines the input of the fit of a local light.

use glam::DVec3;

use crate::fit::axes::LightAxes;
use crate::fit::boxes::Boxes;
use crate::fit::region::HalfSpaces;
use crate::fit::visible::Receivers;

/// Is the largest number of views of one local light.
pub(crate) const MAX_LOCAL_VIEWS: usize = 6;

/// Holds the input of a frame.
pub(crate) struct LocalInput<'a> {
    pub origin: DVec3,
    pub position_world: DVec3,
    /// Is in world units and may be infinite.
    pub range: f64,
    /// Holds the axes of each view, which looks against its z axis.
    pub views: &'a [LightAxes],
    /// Is the tangent of half the angle over which a view has receivers.
    pub receiver_tangent: f64,
    /// Holds the same for the casters of each view: wider by the reach of a kernel at the border.
    pub caster_tangents: [f64; MAX_LOCAL_VIEWS],
    /// States that lookups reach beyond the position of their receiver: views are then not limited
    /// to where receivers are seen.
    pub looks_around: bool,
    /// Holds the regions in which receivers count: what the cameras see, or everywhere.
    pub seen: &'a [HalfSpaces],
    /// Holds the bounds of what casts; empty ones cast nothing.
    pub casters: Boxes<'a>,
    pub receivers: Receivers<'a>,
    /// Counts the texels per side of each view.
    pub sizes_texels: [u32; MAX_LOCAL_VIEWS],
    /// Is the number of texels per side of a view for which near planes are chosen.
    pub near_plane_texels: u32,
    pub margin_texels: u32,
}
