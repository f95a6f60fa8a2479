//! Defines where a view is in the world.

use glam::DVec3;

use crate::fit::axes::LightAxes;
use crate::fit::map_rect::{LightSpaceBounds, MapRect};

/// Describes what a view covers, in absolute world terms: two views with equal placements render
/// the same map of the same world, wherever render space begins.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum ViewPlacement {
    Orthographic {
        axes: LightAxes,
        bounds: LightSpaceBounds,
    },
    Perspective {
        axes: LightAxes,
        position_world: DVec3,
        /// Is in tangents.
        rect: MapRect,
        /// Is the world distance of the near plane.
        near: f64,
        /// Is the cosine of the half-angle of a cone; -2 if there is no cone.
        cone_cosine: f64,
    },
}

impl ViewPlacement {
    /// Returns the world distance of the view's farthest corner, or of a local light, from the
    /// world's origin.
    pub(super) fn reach_from_origin(&self) -> f64 {
        match self {
            Self::Orthographic { bounds, .. } => bounds.bounds().reach(),
            Self::Perspective { position_world, .. } => position_world.length(),
        }
    }

    /// Returns the rectangle of the map plane: in world units for an orthographic view, in tangents
    /// for a perspective one.
    pub(super) const fn rect(&self) -> &MapRect {
        match self {
            Self::Orthographic { bounds, .. } => &bounds.rect,
            Self::Perspective { rect, .. } => rect,
        }
    }
}
