//! Fits the views of a local light: the part of each that receivers and casters share, and its near
//! plane.
//!
//! Map coordinates of a perspective view are tangents, x / w and y / w with w the distance along
//! the view's axis, and ndc depth is near / w (reversed, infinite far plane): its relative error is
//! that of f32 at any distance.

use glam::{DVec2, DVec3, UVec2};

use crate::fit::change_log::ChangedBoxes;
use crate::fit::local_input::{LocalInput, MAX_LOCAL_VIEWS};
use crate::fit::local_view::ViewFrame;
use crate::fit::map_rect::{HeldRect, MapRect, MapRectRequest};
use crate::fit::reached::{self, FarthestSeen, Reached};
use crate::fit::region::HalfSpaces;
use crate::fit::size_step::HeldSize;

/// Holds the map rectangles and near planes of a local light, kept from frame to frame for their
/// hysteresis.
#[derive(Clone, Debug, Default)]
pub(crate) struct LocalFit {
    /// Holds rectangles in tangents, `None` for a view in which nothing can cast a shadow.
    pub rects: [Option<MapRect>; MAX_LOCAL_VIEWS],
    held: [Option<HeldRect>; MAX_LOCAL_VIEWS],
    /// Is the world distance of each view's near plane along its axis, 0 for a view that has never
    /// been needed.
    pub near: [f64; MAX_LOCAL_VIEWS],
    /// Is the largest world distance, along an axis, of a corner of a caster of each view from the
    /// light.
    pub caster_reach: [f64; MAX_LOCAL_VIEWS],
    /// Is the world distance up to which receivers are seen, rounded up to a size step, and at most
    /// the light's range.
    pub reach: f64,
    /// Holds the same distance before the range limits it; `None` where no receiver is seen within
    /// the range.
    held_reach: Option<HeldSize>,
    requests: LocalRequests,
}

/// Is what a light was last fitted to, so that it can be fitted to it again.
#[derive(Clone, Debug, Default)]
struct LocalRequests {
    /// Is the farthest point of a receiver that is seen.
    seen: FarthestSeen,
    /// Is slightly more than its distance; `None` where nothing is seen or it is at the range.
    farthest: Option<f64>,
    /// Is the light's range.
    range: f64,
    /// Holds the request for each of the rectangles, with the distance of a near plane.
    views: [Option<(MapRectRequest, f64)>; MAX_LOCAL_VIEWS],
}

impl LocalFit {
    /// Returns the fit for this frame. Each list of `drawn` is filled with the indices of the
    /// casters of one view.
    pub(crate) fn fit(
        &self,
        input: &LocalInput<'_>,
        reached: &mut Reached,
        drawn: &mut [Vec<u32>],
    ) -> Self {
        let light = input.position_world - input.origin;
        let seen = reached::farthest_seen(input, light, &cone(input, light));
        let (reach, held_reach, farthest) = self.reach(input, light, seen.distance);
        let mut next = Self {
            rects: [None; MAX_LOCAL_VIEWS],
            reach,
            held_reach,
            requests: LocalRequests {
                seen,
                farthest,
                range: input.range,
                views: [None; MAX_LOCAL_VIEWS],
            },
            ..self.clone()
        };
        drawn.iter_mut().for_each(Vec::clear);
        if reach <= 0.0 {
            return next;
        }
        reached.find(input, light, reach);
        let nearest = reached.nearest();
        for (index, axes) in input.views.iter().enumerate() {
            let view = ViewFrame { axes, light };
            let Some((min, max)) = view.needed(input, index, reached, nearest) else {
                continue;
            };
            let request = MapRectRequest {
                min,
                max,
                size_texels: UVec2::splat(input.sizes_texels[index]),
                margin_texels: input.margin_texels,
                texel_floor: texel_floor(light, reach),
                full_half_side: input.caster_tangents[index],
            };
            let held_rect = HeldRect::fit(&request, self.held[index].as_ref());
            let rect = held_rect.rect;
            let region = view.region(rect.min, rect.max(), nearest);
            // The rectangle may be wider than the square of the casters that it was fitted to.
            reached.find_candidates(&region, light);
            let (mut near, mut caster_reach) = (f64::INFINITY, 0.0_f64);
            for caster in reached.candidates() {
                // From there on the power of two below the distance is no less than the near plane.
                let enough = power_of_two_above(near);
                if let Some(distance) = view.nearest_within(&region, &caster.bounds, enough) {
                    drawn[index].push(caster.index);
                    if distance < enough {
                        near = near.min(near_plane(distance, caster.nearest));
                    }
                    caster_reach = caster_reach.max(caster.farthest_corner);
                }
            }
            if !drawn[index].is_empty() {
                next.rects[index] = Some(rect);
                next.held[index] = Some(held_rect);
                next.caster_reach[index] = caster_reach;
                // A caster may begin where the reach ends; the view still has a depth range then.
                let near = near.min(0.5 * reach);
                next.near[index] = steady_near(near, self.near[index]);
                next.requests.views[index] = Some((request, near));
            }
        }
        next
    }

    /// Returns the size, in tangents, of what a view has to cover; `None` for a view in which
    /// nothing can cast a shadow.
    pub(crate) fn needed_size(&self, view: usize) -> Option<DVec2> {
        self.rects[view]?;
        let (request, _) = self.requests.views[view].as_ref()?;
        Some(request.max - request.min)
    }

    /// Returns the fit for a frame in which nothing differs from the last. Only the time counts for
    /// which extents have been larger than needed. Returns `None` where that time is over, so that
    /// the whole fit is needed.
    pub(crate) fn again(&self) -> Option<Self> {
        let mut next = self.clone();
        if let Some(farthest) = self.requests.farthest {
            let held = HeldSize::following(self.held_reach, farthest);
            if held.step().min(self.requests.range) != self.reach {
                return None;
            }
            next.held_reach = Some(held);
        }
        for (index, request) in self.requests.views.iter().enumerate() {
            if let Some((request, near)) = request {
                let held = HeldRect::fit(request, self.held[index].as_ref());
                let same_near = steady_near(*near, self.near[index]) == self.near[index];
                if Some(held.rect) != self.rects[index] || !same_near {
                    return None;
                }
                next.held[index] = Some(held);
            }
        }
        Some(next)
    }

    /// Returns whether the fit may become another, or may have other casters, where these boxes
    /// change. `input` is otherwise that of the last fit.
    pub(crate) fn may_change(&self, input: &LocalInput<'_>, changes: ChangedBoxes<'_>) -> bool {
        let light = input.position_world - input.origin;
        let (cone, last) = (cone(input, light), (&self.requests.seen, self.reach));
        let mut changes = changes.iter();
        changes.any(|changed| reached::may_change(changed, last, input, light, &cone))
    }

    /// Returns the distance up to which the light matters: where the farthest receiver that is seen
    /// ends, and at most the light's range. It grows with what is seen at once, and shrinks late.
    /// The second value is its hysteresis, and the third the distance that this was fitted to.
    fn reach(
        &self,
        input: &LocalInput<'_>,
        light: DVec3,
        farthest: f64,
    ) -> (f64, Option<HeldSize>, Option<f64>) {
        if farthest <= 0.0 || farthest >= input.range {
            return (farthest.min(input.range), self.held_reach, None);
        }
        // Vertices of what is seen are found within rounding.
        let farthest = farthest * (1.0 + 1e-6) + light.abs().max_element() * 1e-6;
        let held = HeldSize::following(self.held_reach, farthest);
        (held.step().min(input.range), Some(held), Some(farthest))
    }
}

/// Returns the region within which a light has receivers.
fn cone(input: &LocalInput<'_>, light: DVec3) -> HalfSpaces {
    // The six faces of a cube cover all directions together. The one view of a cone does not.
    match input.views {
        [axes] => {
            let tangent = DVec2::splat(input.receiver_tangent);
            ViewFrame { axes, light }.region(-tangent, tangent, 0.0)
        }
        _ => HalfSpaces::default(),
    }
}

/// Returns the near plane for a caster that begins `distance` along the axis and need not be
/// resolved below `nearest`. The distance is rounded down to a power of two, so that it changes
/// rarely.
fn near_plane(distance: f64, nearest: f64) -> f64 {
    power_of_two_below(distance.max(nearest)).max(nearest)
}

/// Returns the largest power of two that is at most `value`, which is positive and at least
/// 2⁻¹⁰²²: the number without its mantissa.
fn power_of_two_below(value: f64) -> f64 {
    f64::from_bits(value.to_bits() & f64::INFINITY.to_bits())
}

/// Returns the least power of two that is at least `value`.
fn power_of_two_above(value: f64) -> f64 {
    let below = power_of_two_below(value);
    if below < value { 2.0 * below } else { below }
}

/// Returns the near plane to use for `near` where `held` is in use: a caster that comes and goes
/// across a power of two changes it once.
fn steady_near(near: f64, held: f64) -> f64 {
    if held <= near && 2.0 * held >= near {
        held
    } else {
        near
    }
}

/// Returns the finest texel, as a tangent: four ulps of f32 at the light's render coordinates seen
/// from the end of its reach, and at least four ulps of one, the tangent at a view's border. Close
/// to the light texels may be finer than positions; at the end of its reach they are not.
fn texel_floor(light: DVec3, reach: f64) -> f64 {
    4.0 * f64::from(f32::EPSILON) * (light.abs().max_element() / reach).max(1.0)
}
