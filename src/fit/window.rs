//! The orthographic window of one cascade: quantised extents, snapped to whole texels in absolute light space.

use glam::DVec2;

use crate::fit::LightBox;
use crate::fit::ladder::rung_with_hysteresis;

/// Steps into which a depth range is divided; its ends lie on whole steps, so that they rarely move.
const DEPTH_STEPS: f64 = 64.0;

/// What one window must hold, and at which resolution.
#[derive(Clone, Copy, Debug)]
pub(crate) struct WindowRequest {
    /// xy: what must be covered. z: the deepest receiver (min) and the nearest caster (max). Absolute light space.
    pub required: LightBox,
    /// Texels per side of the map.
    pub map_size: u32,
    /// Texels kept free on every side, so that a filter's kernel stays inside.
    pub margin_texels: u32,
    /// Finest texel that render space can tell apart at this place, in world units.
    pub texel_floor: f64,
}

/// A rectangle of whole texels and a depth range, in absolute light space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct OrthoWindow {
    /// Least x and y: a whole number of texels from the world's origin.
    pub min: DVec2,
    /// Size of a texel along x and y.
    pub texel: DVec2,
    /// z of the far plane (ndc 0).
    pub far: f64,
    /// z of the near plane (ndc 1); greater than `far`, since z grows toward the light.
    pub near: f64,
    /// Texels per side.
    pub map_size: u32,
}

impl OrthoWindow {
    /// The window for `request`. The `held` one stays wholly or in part as long as it serves, so that small motions of a
    /// camera change nothing.
    pub fn fit(request: &WindowRequest, held: Option<&Self>) -> Self {
        let held = held.filter(|held| held.map_size == request.map_size);
        let (min_x, texel_x) = fit_axis(request, held, 0);
        let (min_y, texel_y) = fit_axis(request, held, 1);
        let (far, near) = fit_depth(request, held, texel_x.max(texel_y));
        Self {
            min: DVec2::new(min_x, min_y),
            texel: DVec2::new(texel_x, texel_y),
            far,
            near,
            map_size: request.map_size,
        }
    }

    /// Greatest x and y.
    pub fn max(&self) -> DVec2 {
        self.min + self.texel * f64::from(self.map_size)
    }

    /// From the near to the far plane in world units.
    pub fn depth_range(&self) -> f64 {
        self.near - self.far
    }

    /// Can geometry in `bounds` leave a mark in this map?
    pub fn holds_part_of(&self, bounds: &LightBox) -> bool {
        let as_box = LightBox {
            min: self.min.extend(self.far),
            max: self.max().extend(self.near),
        };
        as_box.overlaps_xy(bounds) && bounds.max.z > self.far
    }
}

/// Start and texel size along one axis.
fn fit_axis(request: &WindowRequest, held: Option<&OrthoWindow>, axis: usize) -> (f64, f64) {
    let (low, high) = (request.required.min[axis], request.required.max[axis]);
    let size = f64::from(request.map_size);
    let margin = f64::from(request.margin_texels);
    // One texel is lost to snapping. A map smaller than its margins keeps one texel and a window that is all margin.
    let usable = (size - 2.0 * margin - 1.0).max(1.0);
    let texel_needed = ((high - low) / usable).max(request.texel_floor);
    let texel = rung_with_hysteresis(texel_needed, held.map(|held| held.texel[axis]));
    if let Some(held) = held.filter(|held| held.texel[axis] == texel) {
        let start = held.min[axis];
        if start + margin * texel <= low && high <= start + (size - margin) * texel {
            return (start, texel);
        }
    }
    let first = (low / texel).floor();
    let covered = (high / texel).ceil() - first;
    let spare = ((size - 2.0 * margin - covered) * 0.5).floor().max(0.0);
    ((first - margin - spare) * texel, texel)
}

/// Far and near plane.
fn fit_depth(request: &WindowRequest, held: Option<&OrthoWindow>, texel: f64) -> (f64, f64) {
    let (far, near) = (request.required.min.z, request.required.max.z);
    // Room for one step behind the deepest receiver, so that rounding never puts it behind the far plane, and two of snapping.
    let needed = (near - far).max(texel) * DEPTH_STEPS / (DEPTH_STEPS - 4.0);
    let range = rung_with_hysteresis(needed, held.map(OrthoWindow::depth_range));
    let step = range / DEPTH_STEPS;
    if let Some(held) = held.filter(|held| held.depth_range() == range) {
        if held.far + step <= far && near <= held.near {
            return (held.far, held.near);
        }
    }
    let far = ((far / step).floor() - 1.0) * step;
    (far, far + range)
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;

    fn request(min: DVec3, max: DVec3) -> WindowRequest {
        WindowRequest {
            required: LightBox { min, max },
            map_size: 512,
            margin_texels: 3,
            texel_floor: 1e-6,
        }
    }

    fn assert_holds(window: &OrthoWindow, request: &WindowRequest) {
        let margin = window.texel * f64::from(request.margin_texels);
        let required = request.required;
        assert!((window.min + margin).cmple(required.min.truncate()).all());
        assert!((window.max() - margin).cmpge(required.max.truncate()).all());
        assert!(window.far < required.min.z && window.near >= required.max.z);
    }

    /// Wherever the required box lies, the window holds it with its margin, starts on a whole texel, and is at most one rung
    /// (1.19) and four texels larger than asked.
    #[test]
    fn windows_hold_what_they_must_and_little_more() {
        for step in 0..2000 {
            let t = f64::from(step);
            let center = DVec3::new((t * 0.713).sin() * 1e5, (t * 0.317).cos() * 1e3, t);
            let half = DVec3::new(0.1 + t * 0.05, 3.0 + (t * 0.1).sin(), 1.0 + t);
            let request = request(center - half, center + half);
            let window = OrthoWindow::fit(&request, None);
            assert_holds(&window, &request);
            let phase = window.min / window.texel;
            assert!((phase - phase.round()).abs().max_element() < 1e-4);
            let ideal = half.truncate() * 2.0 / 505.0;
            assert!((window.texel / ideal).max_element() <= 2.0_f64.powf(0.25) * (1.0 + 1e-9));
        }
    }

    /// A request that drifts less than the spare room changes nothing at all; one that leaves it moves by whole texels.
    #[test]
    fn a_held_window_stays_until_it_must_move() {
        let first = request(DVec3::new(-4.0, -3.0, -10.0), DVec3::new(4.3, 3.1, 5.0));
        let held = OrthoWindow::fit(&first, None);
        let nudge = DVec3::new(held.texel.x * 0.4, -held.texel.y * 0.3, 1e-4);
        let second = request(first.required.min + nudge, first.required.max + nudge);
        assert_eq!(OrthoWindow::fit(&second, Some(&held)), held);
        let far = DVec3::new(7.0, 0.0, 0.0);
        let third = request(first.required.min + far, first.required.max + far);
        let moved = OrthoWindow::fit(&third, Some(&held));
        assert_holds(&moved, &third);
        assert_eq!(moved.texel, held.texel);
        let texels = (moved.min - held.min) / held.texel;
        assert!((texels - texels.round()).abs().max_element() < 1e-9);
    }

    #[test]
    fn maps_smaller_than_their_margins_and_flat_boxes_stay_finite() {
        for map_size in [1, 2, 3, 7] {
            let point = DVec3::splat(2.5);
            let mut request = request(point, point);
            request.map_size = map_size;
            let window = OrthoWindow::fit(&request, None);
            assert!(window.texel.min_element() > 0.0 && window.depth_range() > 0.0);
            assert!(window.min.is_finite() && window.near.is_finite());
        }
    }
}
