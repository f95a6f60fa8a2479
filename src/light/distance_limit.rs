//! Determines at which distance from the cameras, or from a local light, shadows end.

use glam::DVec2;

use crate::fit::{CameraFrustum, FitInput, LightSpaceBounds, Region};
use crate::receive::{ALL_TEXELS, NO_LIMIT};

/// Is the least fraction of the distance over which shadows fade. It makes a sharp end. The weight
/// is a difference of numbers of the size of its reciprocal, whose rounding comes to four ulps, or
/// half a hundredth.
const LEAST_FADE: f64 = 1e-4;

/// Is the cosine of the largest angle, 20 degrees, between cameras that count as looking the same
/// way: the two eyes of a headset do, even where its displays are turned outward by ten degrees
/// each.
const SAME_WAY_COSINE: f64 = 0.939_692_620_785_908_4;

/// Returns the uniform's plane at which shadows end. It is at the farthest end of all cameras if
/// all of them have one and look the same way; otherwise the result is [`NO_LIMIT`], and shadows
/// end where the maps end.
pub(crate) fn distance_limit(region: Region<'_>, fade: f32) -> [f32; 4] {
    let Region::Cameras(cameras @ [first, ..]) = region else {
        return NO_LIMIT;
    };
    let forward = first.forward();
    let end = |camera: &CameraFrustum| {
        let same_way = camera.forward().dot(forward) > SAME_WAY_COSINE;
        let end = forward.dot(camera.eye()) + camera.max_distance();
        if same_way { end } else { f64::INFINITY }
    };
    let end = cameras.iter().map(end).fold(f64::NEG_INFINITY, f64::max);
    if !end.is_finite() {
        return NO_LIMIT;
    }
    let distance = cameras.iter().map(CameraFrustum::max_distance);
    let over = distance.fold(0.0, f64::max) * f64::from(fade).max(LEAST_FADE);
    (-forward / over).extend(end / over).as_vec4().to_array()
}

/// Is the number of texels beyond a covered box up to which shadows reach. Positions are rounded by
/// less than a texel, so that surfaces on the sides of the box have their shadows.
const TEXELS_BEYOND_BOX: f64 = 1.0;

/// Returns the texels in which positions have shadows, in a map of a directional light with
/// `bounds`: those of the covered box, or all where no box is covered.
pub(crate) fn shadowed_texels(input: &FitInput<'_>, bounds: Option<&LightSpaceBounds>) -> [f32; 4] {
    let (Region::Bounds(covered), Some(bounds)) = (&input.region, bounds) else {
        return ALL_TEXELS;
    };
    let covered = input.space.bounds(covered);
    let rect = &bounds.rect;
    // Rows of texels grow downward.
    let least = DVec2::new(covered.min.x - rect.min.x, rect.max().y - covered.max.y) / rect.texel;
    let greatest =
        DVec2::new(covered.max.x - rect.min.x, rect.max().y - covered.min.y) / rect.texel;
    let (least, greatest) = (least - TEXELS_BEYOND_BOX, greatest + TEXELS_BEYOND_BOX);
    [least.x, least.y, greatest.x, greatest.y].map(|texel| texel as f32)
}

/// Returns the uniform's coefficients by which shadows fade toward the end of a light's range.
pub(crate) fn range_limit(range: f32, fade: f32) -> [f32; 4] {
    if fade == 0.0 {
        return NO_LIMIT;
    }
    [1.0 / (range * fade), 0.0, 0.0, 1.0 / fade]
}
