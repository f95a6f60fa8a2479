//! Finds what one view of a local light has to cover of boxes, and which boxes it has to draw.
//!
//! Map coordinates of a perspective view are tangents, x / w and y / w with w the distance along
//! the view's axis.

use glam::{DVec2, DVec3};

use crate::Aabb;
use crate::fit::axes::{LightAxes, LightSpace};
use crate::fit::local_input::LocalInput;
use crate::fit::reached::Reached;
use crate::fit::region::{HalfSpace, HalfSpaces, Relation};

/// Holds one view's axes at the light's position in render space.
pub(crate) struct ViewFrame<'a> {
    pub axes: &'a LightAxes,
    pub light: DVec3,
}

impl ViewFrame<'_> {
    /// Returns the rectangle of tangents that both casters and receivers cover, or `None` if they
    /// share none. Where lookups reach around their receiver, casters alone decide.
    pub(super) fn needed(
        &self,
        input: &LocalInput<'_>,
        index: usize,
        reached: &mut Reached,
        nearest: f64,
    ) -> Option<(DVec2, DVec2)> {
        let square =
            |tangent: f64| self.region(DVec2::splat(-tangent), DVec2::splat(tangent), nearest);
        let tangent = input.caster_tangents[index];
        let region = square(tangent);
        reached.find_candidates(&region, self.light);
        let casters = reached.candidates().map(|caster| &caster.bounds);
        let cast = self.extent(&region, tangent, casters)?;
        if input.looks_around {
            return Some((cast.min, cast.max));
        }
        let tangent = input.receiver_tangent;
        let mut received = Extent::nothing(tangent);
        for region in input.seen {
            let mut seen = square(tangent);
            let planes = region.as_slice().iter();
            planes.for_each(|plane| seen.push(*plane));
            let receivers = reached.receivers_in(&seen, self.light);
            if let Some(extent) = self.extent(&seen, tangent, receivers) {
                received.min = received.min.min(extent.min);
                received.max = received.max.max(extent.max);
            }
        }
        let (min, max) = (cast.min.max(received.min), cast.max.min(received.max));
        min.cmple(max).all().then_some((min, max))
    }

    /// Returns the pyramid over a rectangle of tangents, cut off at `nearest` along the axis.
    pub(super) fn region(&self, min: DVec2, max: DVec2, nearest: f64) -> HalfSpaces {
        let (right, up, forward) = (self.axes.right(), self.axes.up(), -self.axes.toward_light());
        let mut region = HalfSpaces::default();
        // The near side comes first: it rejects half of all boxes.
        region.push(HalfSpace {
            normal: forward,
            offset: -forward.dot(self.light) - nearest,
        });
        for side in [
            right - forward * min.x,
            forward * max.x - right,
            up - forward * min.y,
            forward * max.y - up,
        ] {
            let normal = side.normalize();
            region.push(HalfSpace {
                normal,
                offset: -normal.dot(self.light),
            });
        }
        region
    }

    /// Returns the rectangle of tangents that the boxes cover within the region, which lies within
    /// the square of tangents up to `tangent`, or `None` where no box is in it.
    fn extent<'b>(
        &self,
        region: &HalfSpaces,
        tangent: f64,
        boxes: impl Iterator<Item = &'b Aabb>,
    ) -> Option<Extent> {
        let mut extent = Extent::nothing(tangent);
        let add = |extent: &mut Extent, span: &Span, point: DVec3| {
            let local = self.axes.light_from_world * (point - self.light);
            let distance = -local.z;
            let rounding = tangent_rounding(tangent, span.coordinate / distance);
            extent.add(local.truncate() / distance, rounding);
        };
        // The corners come first, so that few boxes are left to be cut.
        let mut left = Vec::new();
        for bounds in boxes {
            let span = self.span(bounds);
            if extent.holds(&span) {
                continue;
            }
            let relation = region.relation(bounds);
            if relation == Relation::Outside {
                continue;
            }
            let corners = (0..8).map(|corner| bounds.corner(corner).as_dvec3());
            corners
                .filter(|corner| relation == Relation::Inside || region.holds(*corner))
                .for_each(|corner| add(&mut extent, &span, corner));
            if relation == Relation::Across {
                left.push((bounds, span));
            }
        }
        for (bounds, span) in left {
            if !extent.holds(&span) {
                region.visit_vertices(bounds, |vertex| add(&mut extent, &span, vertex));
            }
        }
        extent.min.cmple(extent.max).all().then_some(extent)
    }

    /// Returns a distance along the axis of the part of a box within the region, or `None` where no
    /// part is: the least one if that is below `enough`, and otherwise any that is not below
    /// `enough` either.
    pub(super) fn nearest_within(
        &self,
        region: &HalfSpaces,
        bounds: &Aabb,
        enough: f64,
    ) -> Option<f64> {
        match region.relation(bounds) {
            Relation::Outside => None,
            Relation::Inside => Some(self.span(bounds).nearest),
            Relation::Across => {
                let span = self.span(bounds);
                if span.nearest >= enough && self.surely_meets(region, bounds, &span) {
                    return Some(span.nearest);
                }
                let mut nearest = f64::INFINITY;
                region.visit_vertices(bounds, |vertex| {
                    let distance = self.axes.toward_light().dot(self.light - vertex);
                    nearest = nearest.min(distance);
                });
                (nearest < f64::INFINITY).then_some(nearest)
            }
        }
    }

    /// Returns whether one of a few points of a box is in the region: its corners, and the one next
    /// to the axis of the view.
    fn surely_meets(&self, region: &HalfSpaces, bounds: &Aabb, span: &Span) -> bool {
        let distance = (span.nearest + span.farthest) * 0.5;
        let on_axis = self.light - self.axes.toward_light() * distance;
        let next_to_axis = on_axis.clamp(bounds.min.as_dvec3(), bounds.max.as_dvec3());
        let mut corners = (0..8).map(|corner| bounds.corner(corner).as_dvec3());
        region.holds(next_to_axis) || corners.any(|corner| region.holds(corner))
    }

    /// Returns the box's intervals on the view's axes, measured from the light.
    fn span(&self, bounds: &Aabb) -> Span {
        let around_light = LightSpace {
            axes: *self.axes,
            origin: -self.light,
        };
        let local = around_light.bounds(bounds);
        Span {
            min: local.min.truncate(),
            max: local.max.truncate(),
            nearest: -local.max.z,
            farthest: -local.min.z,
            coordinate: {
                let corners = bounds.min.abs().max(bounds.max.abs()).max_element();
                f64::from(corners) + self.light.abs().max_element()
            },
        }
    }
}

/// Is a rectangle of tangents within a square of them.
struct Extent {
    min: DVec2,
    max: DVec2,
    /// Is half the side of the square.
    limit: f64,
}

/// Holds a box's intervals across the view, and along it away from the light.
struct Span {
    min: DVec2,
    max: DVec2,
    nearest: f64,
    farthest: f64,
    /// Is the largest render coordinate that they are computed from.
    coordinate: f64,
}

impl Span {
    /// Returns more than tangents of points in the box may be off: so it does not matter which of
    /// several equal ones is found first.
    fn rounding(&self) -> f64 {
        let widest = self.min.abs().max(self.max.abs()).max_element() / self.nearest;
        tangent_rounding(widest, self.coordinate / self.nearest)
    }
}

/// Returns more than tangents up to `widest` may be off, of points whose coordinates are at most
/// `coordinate_per_distance` times their distance along the axis.
fn tangent_rounding(widest: f64, coordinate_per_distance: f64) -> f64 {
    64.0 * f64::EPSILON * (1.0 + widest) * coordinate_per_distance
}

impl Extent {
    const fn nothing(limit: f64) -> Self {
        Self {
            min: DVec2::INFINITY,
            max: DVec2::NEG_INFINITY,
            limit,
        }
    }

    /// Extends the rectangle to tangents that may be off by `rounding`. Those that are within it of
    /// the border of the square are on the border, whichever box they come from.
    fn add(&mut self, tangents: DVec2, rounding: f64) {
        let border = DVec2::splat(self.limit - rounding);
        let limit = DVec2::splat(self.limit);
        let high = DVec2::select(tangents.cmpge(border), limit, tangents);
        let low = DVec2::select(tangents.cmple(-border), -limit, tangents);
        self.min = self.min.min(low);
        self.max = self.max.max(high);
    }

    /// Returns whether all tangents of the box that are in the square are within these already.
    fn holds(&self, span: &Span) -> bool {
        if span.nearest <= 0.0 {
            return false;
        }
        let at = |across: DVec2| (across / span.nearest, across / span.farthest);
        let (low_near, low_far) = at(span.min);
        let (high_near, high_far) = at(span.max);
        let limit = DVec2::splat(self.limit);
        let low = (low_near.min(low_far) - span.rounding()).max(-limit);
        let high = (high_near.max(high_far) + span.rounding()).min(limit);
        self.min.cmple(low).all() && self.max.cmpge(high).all()
    }
}
