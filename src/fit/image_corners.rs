//! Computes the corners of a camera's image at any depth, and the sphere around a slice of its
//! view.

use glam::{DMat4, DVec3};

/// Is a sphere around a slice of a camera's volume.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SliceSphere {
    pub center_render: DVec3,
    pub radius: f64,
}

/// Holds the corners of a camera's image in view space. Spheres are made from them, so that no
/// rounding of the camera's pose reaches a radius.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ImageCorners {
    /// Holds, for each corner, its position at depth zero and what a unit of depth adds.
    rays: [(DVec3, DVec3); 4],
    pub depth_near: f64,
    /// Is infinite for a projection without a far plane.
    pub depth_far: f64,
}

/// Lists the corners of an image in ndc.
const CORNERS_NDC: [(f64, f64); 4] = [(-1.0, -1.0), (1.0, -1.0), (-1.0, 1.0), (1.0, 1.0)];

impl ImageCorners {
    pub(super) fn new(clip_from_view: &DMat4, forward_view: DVec3) -> Self {
        let view_from_clip = clip_from_view.inverse();
        let at = |x, y, z| {
            let point = view_from_clip * DVec3::new(x, y, z).extend(1.0);
            (point.truncate(), point.w)
        };
        let rays = CORNERS_NDC.map(|(x, y)| {
            // Either of the two may be at infinity.
            let [(first, first_w), (second, second_w)] = [0.25, 0.75].map(|z| at(x, y, z));
            let direction = second * first_w - first * second_w;
            let per_depth = direction / forward_view.dot(direction);
            let position = if first_w.abs() > second_w.abs() {
                first / first_w
            } else {
                second / second_w
            };
            (position - per_depth * forward_view.dot(position), per_depth)
        });
        // This is the depth of a corner of the near or far plane. Oblique planes have one corner
        // nearer than their middle, and may extend beyond infinity.
        let depth = |(x, y), z| {
            let (point, w) = at(x, y, z);
            if w <= 1e-12 * point.length() {
                f64::INFINITY
            } else {
                forward_view.dot(point / w)
            }
        };
        let depths = CORNERS_NDC.map(|corner| [depth(corner, 0.0), depth(corner, 1.0)]);
        let depths = depths.iter().flatten().copied();
        Self {
            rays,
            depth_near: depths.clone().fold(f64::INFINITY, f64::min),
            depth_far: depths.fold(f64::NEG_INFINITY, f64::max),
        }
    }

    /// Returns the corners at a depth.
    pub(super) fn at(&self, depth: f64) -> [DVec3; 4] {
        self.rays
            .map(|(start, per_depth)| start + per_depth * depth)
    }

    /// Returns centre and radius of the smallest sphere with its centre on the slice's axis that
    /// holds the slice between two depths.
    pub(super) fn sphere_in_view(&self, depth_near: f64, depth_far: f64) -> (DVec3, f64) {
        let middle = |corners: &[DVec3; 4]| corners.iter().sum::<DVec3>() * 0.25;
        let (near, far) = (self.at(depth_near), self.at(depth_far));
        let (near_middle, far_middle) = (middle(&near), middle(&far));
        let reach = |middle: DVec3, corners: &[DVec3; 4]| {
            let distances = corners.iter().map(|corner| corner.distance_squared(middle));
            distances.fold(0.0, f64::max)
        };
        let length = near_middle.distance(far_middle);
        // The centre is equally far from the near and the far corners: (l - t)² + rf² = t² + rn².
        let share = if length > 0.0 {
            let squares = reach(far_middle, &far) - reach(near_middle, &near);
            (0.5 + 0.5 * squares / (length * length)).clamp(0.0, 1.0)
        } else {
            0.0
        };
        let center = near_middle.lerp(far_middle, share);
        let radius = reach(center, &near).max(reach(center, &far)).sqrt();
        (center, radius)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::dcamera::rh::proj::directx::{perspective, perspective_infinite_reverse};

    /// Checks with depths 1 to 9 and tangents 0.5 and 1 that forward and reversed projections, with
    /// and without a far plane, agree about a slice; its corners are on or in the sphere, at least
    /// those of two depths on it.
    #[test]
    fn a_sphere_holds_its_slice() {
        let projections = [
            perspective(0.927_295_218_001_612_2, 2.0, 1.0, 9.0),
            perspective(0.927_295_218_001_612_2, 2.0, 9.0, 1.0),
            perspective_infinite_reverse(0.927_295_218_001_612_2, 2.0, 1.0),
        ];
        for (index, projection) in projections.iter().enumerate() {
            let corners = ImageCorners::new(projection, DVec3::NEG_Z);
            assert!((corners.depth_near - 1.0).abs() < 1e-9, "{index}");
            let far = if index == 2 { f64::INFINITY } else { 9.0 };
            assert!(corners.depth_far == far || (corners.depth_far - far).abs() < 1e-9);
            let (center, radius) = corners.sphere_in_view(2.0, 6.0);
            // By hand: the near corners are 2·√1.25 from the axis, the far ones 6·√1.25; the centre
            // would be (4² + 45 - 5) / (2 · 4) = 7 behind the near end, which is past the far one.
            assert!((center - DVec3::new(0.0, 0.0, -6.0)).length() < 1e-9);
            assert!((radius - 45.0_f64.sqrt()).abs() < 1e-9, "{radius}");
        }
    }

    /// Checks a narrow slice, whose centre is between its ends.
    #[test]
    fn a_long_slice_is_centred_between_its_ends() {
        let projection = perspective(0.2, 1.0, 1.0, 50.0);
        let (center, radius) =
            ImageCorners::new(&projection, DVec3::NEG_Z).sphere_in_view(1.0, 50.0);
        let tangent = (0.1_f64).tan() * std::f64::consts::SQRT_2;
        for depth in [1.0, 50.0] {
            let corner = DVec3::new(tangent * depth, 0.0, -depth);
            assert!((corner.distance(center) - radius).abs() < 1e-9);
        }
    }

    /// Checks that an oblique near plane, such as a mirror's camera has, begins at its nearest
    /// corner: x / 2 + depth = 3, at x = ±depth. With a scale of one half the left corners' depths
    /// at z = 0.25 are infinite.
    #[test]
    fn a_leaning_near_plane_begins_at_its_nearest_corner() {
        for scale in [0.25, 0.5] {
            let mut rows = perspective(std::f64::consts::FRAC_PI_2, 1.0, 1.0, 9.0).transpose();
            rows.z_axis = glam::DVec4::new(0.5, 0.0, -1.0, -3.0) * scale;
            let corners = ImageCorners::new(&rows.transpose(), DVec3::NEG_Z);
            assert!((corners.depth_near - 2.0).abs() < 1e-9, "{corners:?}");
            assert_eq!(corners.depth_far, f64::INFINITY);
            let (center, radius) = corners.sphere_in_view(2.0, 6.0);
            assert!((center - DVec3::new(0.0, 0.0, -6.0)).length() < 1e-9);
            assert!((radius - 72.0_f64.sqrt()).abs() < 1e-9, "{radius}");
        }
    }
}
