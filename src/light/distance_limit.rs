//! Determines at which distance from the cameras, or from a local light, shadows end.

use glam::DVec3;

use crate::fit::{CameraFrustum, Region};
use crate::receive::NO_LIMIT;

/// Is the least fraction of the distance over which shadows fade: less is not distinguishable from
/// a sharp end.
const LEAST_FADE: f64 = 1e-4;

/// Is the cosine of the largest angle between cameras that count as looking the same way, as the
/// eyes of a headset do.
const SAME_WAY_COSINE: f64 = 0.99;

/// Returns the uniform's plane at which shadows end. It is at the farthest end of all cameras if
/// all of them have one and look the same way; otherwise the result is [`NO_LIMIT`], and shadows
/// end where the maps end.
pub(crate) fn distance_limit(region: Region<'_>, fade: f32) -> [f32; 4] {
    let Region::Cameras([first, others @ ..]) = region else {
        return NO_LIMIT;
    };
    let forward = first.forward();
    let end = |camera: &CameraFrustum| {
        let same_way = camera.forward().dot(forward) > SAME_WAY_COSINE;
        let end = -camera.depth(DVec3::ZERO) + camera.max_distance();
        if same_way { end } else { f64::INFINITY }
    };
    let end = others.iter().map(end).fold(end(first), f64::max);
    if !end.is_finite() {
        return NO_LIMIT;
    }
    let over = first.max_distance() * f64::from(fade).max(LEAST_FADE);
    (-forward / over).extend(end / over).as_vec4().to_array()
}

/// Returns the uniform's coefficients by which shadows fade toward the end of a light's range.
pub(crate) fn range_limit(range: f32, fade: f32) -> [f32; 4] {
    if fade == 0.0 {
        return NO_LIMIT;
    }
    [1.0 / (range * fade), 0.0, 0.0, 1.0 / fade]
}
