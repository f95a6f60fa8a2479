//! Fits the rectangle of the map plane that one view covers: quantized extents, snapped to whole
//! texels in absolute coordinates.

use glam::{DVec2, UVec2};

use crate::fit::LightBox;
use crate::fit::size_step::{HeldSize, size_step_up};

/// Is the number of steps into which a depth range is divided; its ends are on whole steps, so that
/// they rarely move.
const DEPTH_STEPS: f64 = 64.0;

/// States what a map rectangle must hold, and at which resolution. Units are the map plane's own:
/// world units in light space for an orthographic view, tangents of angles for a perspective one.
#[derive(Clone, Copy, Debug)]
pub(crate) struct MapRectRequest {
    /// Is the least x and y to cover.
    pub min: DVec2,
    /// Is the greatest x and y to cover.
    pub max: DVec2,
    /// Counts the texels along x and y.
    pub size_texels: UVec2,
    /// Counts the texels kept free on every side, so that a filter's kernel stays inside.
    pub margin_texels: u32,
    /// Is the finest texel that render space can resolve at this position.
    pub texel_floor: f64,
    /// Is half the side of a square around the plane's origin that holds everything that can ever
    /// be needed, margins included; infinite if there is no such square. Where a quantized size
    /// step would make texels no finer than those of the square, the square is used, which never
    /// moves.
    pub full_half_side: f64,
}

/// Is a rectangle of whole texels in the plane of a map.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct MapRect {
    /// Is the least x and y: a whole number of texels from the plane's origin, except where the
    /// rectangle is the full square of its request or too small to snap.
    pub min: DVec2,
    /// Is the size of a texel along x and y.
    pub texel: DVec2,
    /// Counts the texels along x and y.
    pub size_texels: UVec2,
}

impl MapRect {
    /// Returns the greatest x and y.
    pub(crate) fn max(&self) -> DVec2 {
        self.min + self.texel * self.size_texels.as_dvec2()
    }
}

/// Holds a map rectangle from frame to frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct HeldRect {
    pub rect: MapRect,
    /// Holds the sizes of a texel along x and y.
    texels: [HeldSize; 2],
}

impl HeldRect {
    /// Returns the rectangle for `request`. The `held` one is kept, on each axis by itself, as long
    /// as it satisfies the request, so that small motions of a camera change nothing.
    pub(super) fn fit(request: &MapRectRequest, held: Option<&Self>) -> Self {
        let held = held.filter(|held| held.rect.size_texels == request.size_texels);
        let (min_x, texel_x, held_x) = fit_axis(request, held, 0);
        let (min_y, texel_y, held_y) = fit_axis(request, held, 1);
        Self {
            rect: MapRect {
                min: DVec2::new(min_x, min_y),
                texel: DVec2::new(texel_x, texel_y),
                size_texels: request.size_texels,
            },
            texels: [held_x, held_y],
        }
    }
}

/// Returns the start and the texel size along one axis, and the size to be held for the next frame.
fn fit_axis(
    request: &MapRectRequest,
    held: Option<&HeldRect>,
    axis: usize,
) -> (f64, f64, HeldSize) {
    let (low, high) = (request.min[axis], request.max[axis]);
    let size = f64::from(request.size_texels[axis]);
    let margin = f64::from(request.margin_texels);
    // One texel is lost to snapping. A map that is all margin is too small to snap: it is centred
    // on what it covers.
    let usable = size - 2.0 * margin - 1.0;
    if usable < 1.0 {
        let needed = ((high - low) / size).max(request.texel_floor);
        let texel = size_step_up(needed);
        let start = (low + high) * 0.5 - 0.5 * size * texel;
        return (start, texel, HeldSize::new(needed));
    }
    let texel_needed = ((high - low) / usable).max(request.texel_floor);
    let held_size = HeldSize::following(held.map(|held| held.texels[axis]), texel_needed);
    let texel = held_size.step();
    let full_texel = 2.0 * request.full_half_side / size;
    if texel >= full_texel {
        return (-request.full_half_side, full_texel, held_size);
    }
    if let Some(held) = held.filter(|held| held.rect.texel[axis] == texel) {
        let start = held.rect.min[axis];
        if start + margin * texel <= low && high <= start + (size - margin) * texel {
            return (start, texel, held_size);
        }
    }
    let first = (low / texel).floor();
    let covered = (high / texel).ceil() - first;
    let spare = ((size - 2.0 * margin - covered) * 0.5).floor().max(0.0);
    ((first - margin - spare) * texel, texel, held_size)
}

/// Holds the far and near plane of an orthographic view, on whole steps of its range.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct DepthRange {
    /// Is z of the far plane (ndc 0).
    pub far: f64,
    /// Is z of the near plane (ndc 1); greater than `far`, since z grows toward the light.
    pub near: f64,
}

/// Holds a depth range from frame to frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct HeldDepth {
    pub depth: DepthRange,
    length: HeldSize,
}

impl HeldDepth {
    /// Returns a range that holds `far..near` and is at least `least` deep.
    pub(super) fn fit(far: f64, near: f64, least: f64, held: Option<&Self>) -> Self {
        // The range has one step behind the deepest receiver, so that rounding never puts it behind
        // the far plane, and two for snapping.
        let needed = (near - far).max(least) * DEPTH_STEPS / (DEPTH_STEPS - 4.0);
        let length = HeldSize::following(held.map(|held| held.length), needed);
        let range = length.step();
        let step = range / DEPTH_STEPS;
        let held = held.map(|held| held.depth);
        let fits = |held: &DepthRange| held.far + step <= far && near <= held.near;
        let same_length = held.filter(|held| held.length() == range);
        let depth = same_length.filter(fits).unwrap_or_else(|| {
            let far = ((far / step).floor() - 1.0) * step;
            DepthRange {
                far,
                near: far + range,
            }
        });
        Self { depth, length }
    }
}

impl DepthRange {
    /// Returns the world units from the far to the near plane.
    pub(crate) fn length(&self) -> f64 {
        self.near - self.far
    }
}

/// Holds the map rectangle and depth range of an orthographic view, in absolute light space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct LightSpaceBounds {
    pub rect: MapRect,
    pub depth: DepthRange,
}

/// Holds light-space bounds from frame to frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct HeldBounds {
    pub rect: HeldRect,
    pub depth: HeldDepth,
}

/// Is what the bounds of a cascade were fitted to, so that they can be fitted to it again.
#[derive(Clone, Copy, Debug)]
pub(crate) struct BoundsRequest {
    pub rect: MapRectRequest,
    /// Is z of the deepest receiver.
    pub far: f64,
    /// Is z of all that shadows the receivers.
    pub highest: f64,
    /// Is z of the nearest caster that reaches into the bounds.
    pub nearest: f64,
    /// Is the least depth of the range.
    pub least_depth: f64,
    /// Is the range that holds `highest`.
    pub reaching: DepthRange,
}

impl HeldBounds {
    /// Returns the hysteresis after a frame with the same request. Returns `None` where the bounds
    /// themselves change, because they were larger than needed for long enough.
    pub(super) fn again(&self, request: &BoundsRequest) -> Option<Self> {
        let depth =
            |near| HeldDepth::fit(request.far, near, request.least_depth, Some(&self.depth));
        let next = Self {
            rect: HeldRect::fit(&request.rect, Some(&self.rect)),
            depth: depth(request.nearest),
        };
        let same_volume = depth(request.highest).depth == request.reaching;
        (same_volume && next.bounds() == self.bounds()).then_some(next)
    }

    /// Returns the bounds that are held.
    pub(super) fn bounds(&self) -> LightSpaceBounds {
        LightSpaceBounds {
            rect: self.rect.rect,
            depth: self.depth.depth,
        }
    }
}

impl LightSpaceBounds {
    /// Returns whether geometry in `bounds` can cast into this map.
    pub(crate) fn holds_part_of(&self, bounds: &LightBox) -> bool {
        self.bounds().overlaps_xy(bounds) && bounds.max.z > self.depth.far
    }

    /// Returns the box that the view covers.
    pub(crate) fn bounds(&self) -> LightBox {
        LightBox {
            min: self.rect.min.extend(self.depth.far),
            max: self.rect.max().extend(self.depth.near),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn request(min: DVec2, max: DVec2) -> MapRectRequest {
        MapRectRequest {
            min,
            max,
            size_texels: UVec2::splat(512),
            margin_texels: 3,
            texel_floor: 1e-6,
            full_half_side: f64::INFINITY,
        }
    }

    fn assert_holds(rect: &MapRect, request: &MapRectRequest) {
        let margin = rect.texel * f64::from(request.margin_texels);
        assert!((rect.min + margin).cmple(request.min).all());
        assert!((rect.max() - margin).cmpge(request.max).all());
    }

    /// Checks that, wherever the required rectangle is, the map rectangle holds it with its margin
    /// and starts on a whole texel, and that its texel is at most one quantized size step (1.19
    /// times) larger than requested.
    #[test]
    fn rects_hold_what_they_must_and_are_at_most_one_size_step_larger() {
        for step in 0..2000 {
            let t = f64::from(step);
            let center = DVec2::new((t * 0.713).sin() * 1e5, (t * 0.317).cos() * 1e3);
            let half = DVec2::new(0.1 + t * 0.05, 3.0 + (t * 0.1).sin());
            let request = request(center - half, center + half);
            let rect = HeldRect::fit(&request, None).rect;
            assert_holds(&rect, &request);
            let phase = rect.min / rect.texel;
            assert!((phase - phase.round()).abs().max_element() < 1e-4);
            let ideal = half * 2.0 / 505.0;
            assert!((rect.texel / ideal).max_element() <= 2.0_f64.powf(0.25) * (1.0 + 1e-9));
        }
    }

    /// Checks that a request that drifts by less than the spare room changes nothing at all, and
    /// that one that leaves it moves the rectangle by whole texels.
    #[test]
    fn a_held_rect_stays_until_it_must_move() {
        let first = request(DVec2::new(-4.0, -3.0), DVec2::new(4.3, 3.1));
        let held_rect = HeldRect::fit(&first, None);
        let held = held_rect.rect;
        let nudge = DVec2::new(held.texel.x * 0.4, -held.texel.y * 0.3);
        let second = request(first.min + nudge, first.max + nudge);
        assert_eq!(HeldRect::fit(&second, Some(&held_rect)).rect, held);
        let far = DVec2::new(7.0, 0.0);
        let third = request(first.min + far, first.max + far);
        let moved = HeldRect::fit(&third, Some(&held_rect)).rect;
        assert_holds(&moved, &third);
        assert_eq!(moved.texel, held.texel);
        let texels = (moved.min - held.min) / held.texel;
        assert!((texels - texels.round()).abs().max_element() < 1e-9);
    }

    /// Checks that a rectangle that would be as large as the full square is the full square.
    #[test]
    fn a_rect_that_would_be_as_large_as_the_full_square_is_the_full_square() {
        let mut request = request(DVec2::new(-0.9, -0.1), DVec2::new(0.95, 0.1));
        request.full_half_side = 0.97;
        let rect = HeldRect::fit(&request, None).rect;
        assert!(rect.min.x == -0.97 && (rect.max().x - 0.97).abs() <= 4.0 * f64::EPSILON);
        assert!(rect.texel.y < rect.texel.x * 0.25);
        assert_holds(&rect, &request);
    }

    #[test]
    fn depth_ranges_hold_their_ends_and_rarely_move() {
        let mut held: Option<HeldDepth> = None;
        let mut changes = 0;
        for step in 0..1000 {
            let sway = 0.05 * (f64::from(step) * 0.3).sin();
            let (far, near) = (-10.0 + sway, 5.0 - sway);
            let next = HeldDepth::fit(far, near, 1e-6, held.as_ref());
            assert!(next.depth.far < far && near <= next.depth.near);
            changes += usize::from(held.map(|held| held.depth) != Some(next.depth));
            held = Some(next);
        }
        assert!(changes <= 2, "{changes}");
    }

    #[test]
    fn maps_smaller_than_their_margins_and_points_stay_finite() {
        for map_size in [1, 2, 3, 7] {
            let mut request = request(DVec2::splat(2.5), DVec2::splat(2.5));
            request.size_texels = UVec2::splat(map_size);
            let rect = HeldRect::fit(&request, None).rect;
            assert!(rect.texel.min_element() > 0.0 && rect.min.is_finite());
            assert!(rect.min.max_element() < 2.5 && rect.max().min_element() > 2.5);
        }
        let range = HeldDepth::fit(3.0, 3.0, 1e-6, None).depth;
        assert!(range.far < 3.0 && range.near >= 3.0 && range.length() > 0.0);
    }
}
