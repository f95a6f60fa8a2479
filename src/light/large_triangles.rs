//! Measures how much rounding large triangles bring into a view.

use glam::DVec3;

use crate::cast::FrameCasters;
use crate::{Aabb, ShadowView};

/// Is the error of the depths of a large triangle, as a multiple of the rounding of a single
/// coordinate: the sum of products that gives a corner's depth is rounded, and the interpolation
/// between corners is rounded once more.
const LARGE_TRIANGLE_ROUNDING: f64 = 2.0;

/// Returns the largest render coordinate from which depths in the view are computed. Rasterizers
/// interpolate between the corners of a triangle, and each corner is rounded at its own position,
/// so that a triangle whose corners are far outside the view brings their rounding into it. The
/// triangles of a caster are assumed to be of equal size and to cover its bounds; where their
/// number is unknown, they are assumed to be as large as the bounds.
pub(crate) fn depth_reach(view: &ShadowView, casters: &FrameCasters<'_>, drawn: &[u32]) -> f64 {
    let mut reach = view.render_reach();
    let center = view.anchor_render().as_dvec3();
    let radius = reach - center.abs().max_element();
    let boxes = casters.casting();
    for &caster in drawn {
        let bounds = boxes.at(caster);
        if all_corners_within(bounds, center, radius) {
            continue;
        }
        let corners_away = corners_away(bounds, center, radius);
        if corners_away <= radius {
            continue;
        }
        let diagonal = (bounds.max.as_dvec3() - bounds.min.as_dvec3()).length();
        let pairs = f64::from(casters.facts(caster).triangles.max(2)) * 0.5;
        let away = corners_away.min(diagonal / pairs.sqrt());
        reach = reach.max(view.render_reach() + LARGE_TRIANGLE_ROUNDING * away);
    }
    reach
}

/// Returns whether the whole box is within a sphere, whatever the rounding. That is so of most.
fn all_corners_within(bounds: &Aabb, center: DVec3, radius: f64) -> bool {
    let (min, max) = (bounds.min.as_dvec3(), bounds.max.as_dvec3());
    let farthest = (center - min).abs().max((max - center).abs());
    farthest.length_squared() < radius * radius * (1.0 - 1e-12)
}

/// Returns the distance from `center` to the fourth nearest corner of a box, which is the distance
/// of a whole side: near the foot of a high tower, depths follow from the corners at its foot.
/// Returns 0 for a box that surrounds the view (a sphere of `radius`), because its corners give no
/// information: it bounds a terrain of many triangles, or it is wrong.
fn corners_away(bounds: &Aabb, center: DVec3, radius: f64) -> f64 {
    let (min, max) = (bounds.min.as_dvec3(), bounds.max.as_dvec3());
    if min.cmplt(center - radius).all() && max.cmpgt(center + radius).all() {
        return 0.0;
    }
    let mut distances: [f64; 8] =
        std::array::from_fn(|corner| bounds.corner(corner).as_dvec3().distance(center));
    distances.sort_unstable_by(f64::total_cmp);
    distances[3]
}
