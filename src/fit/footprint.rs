//! Measures how much of a cascade's map falls on its slice of the view, and how its texels compare
//! with the image's pixels.

use glam::{DVec2, Vec2};

use crate::Aabb;
use crate::fit::axes::LightSpace;
use crate::fit::camera::CameraFrustum;
use crate::fit::extruded_rect::push_extruded_rect;
use crate::fit::map_rect::MapRect;
use crate::fit::visible::SeenBounds;

/// Reports which slice of the camera's view a cascade covers, and how finely.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct SliceReport {
    /// Is the depth along the view, in world units, at which the cascade's slice begins. For the
    /// first cascade that is the nearest visible receiver, or the camera's near plane under
    /// [`Stability::BoundingSphere`](crate::Stability::BoundingSphere).
    pub depth_near: f32,
    /// Is the depth along the view, in world units, at which the slice ends.
    pub depth_far: f32,
    /// Is the share of the map's texels that fall on the slice, within the bounds of what is
    /// visible: 0 to 1. The rest of the map, most of it where this is small, is behind the camera
    /// or beside its image.
    pub map_utilization: f32,
    /// Counts the texels across the height of the image, on a surface that faces both light and
    /// camera: x is the fewest (coarser axis, nearest depth) and y the most (finer axis, farthest
    /// depth). The counts are infinite where the image has no end at that depth, as under an
    /// oblique projection.
    pub texels_across_image: Vec2,
}

impl SliceReport {
    /// Returns the texels per pixel of an image that is `image_height_pixels` pixels high: x is the
    /// fewest and y the most. Below 1, edges show their texels; far above 1, the map could be
    /// smaller.
    pub fn texels_per_pixel(&self, image_height_pixels: u32) -> Vec2 {
        self.texels_across_image / image_height_pixels as f32
    }
}

/// Holds lists that are reused from frame to frame.
#[derive(Debug, Default)]
pub(crate) struct FootprintScratch {
    points: Vec<DVec2>,
    hull: Vec<DVec2>,
}

/// Is a cascade's slice of a camera's view.
pub(crate) struct Slice<'a> {
    pub camera: &'a CameraFrustum,
    pub visible: &'a SeenBounds,
    pub between: (f64, f64),
}

impl Slice<'_> {
    /// Returns how `rect` covers the slice.
    pub(super) fn report(
        &self,
        space: &LightSpace,
        rect: &MapRect,
        scratch: &mut FootprintScratch,
    ) -> SliceReport {
        let (near, far) = self.between;
        let mut region = self.camera.slice(near, far);
        push_extruded_rect(&mut region, space, (rect.min, rect.max()));
        let visible = Aabb::new(
            self.visible.render_min.as_vec3(),
            self.visible.render_max.as_vec3(),
        );
        // The points are relative to the rectangle, so that a distant origin costs no precision.
        scratch.points.clear();
        region.visit_vertices(&visible, |vertex| {
            scratch
                .points
                .push(space.point(vertex).truncate() - rect.min);
        });
        let size = rect.max() - rect.min;
        let share = hull_area(scratch) / (size.x * size.y);
        let height = |depth| self.camera.image_height(depth);
        let texels = DVec2::new(
            height(near) / rect.texel.max_element(),
            height(far) / rect.texel.min_element(),
        );
        SliceReport {
            depth_near: near as f32,
            depth_far: far as f32,
            map_utilization: share.clamp(0.0, 1.0) as f32,
            texels_across_image: texels.as_vec2(),
        }
    }
}

/// Returns the area of the convex hull of `scratch.points` (Andrew's monotone chain, 1979).
fn hull_area(scratch: &mut FootprintScratch) -> f64 {
    let FootprintScratch { points, hull } = scratch;
    points.sort_unstable_by(|a, b| a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)));
    hull.clear();
    let turns_left = |hull: &[DVec2], next: DVec2| match hull {
        [.., a, b] => (*b - *a).perp_dot(next - *b) > 0.0,
        _ => true,
    };
    // The lower chain goes from left to right, then the upper one back; the second never removes
    // points of the first.
    for &point in points.iter() {
        while hull.len() >= 2 && !turns_left(hull, point) {
            hull.pop();
        }
        hull.push(point);
    }
    let lower = hull.len();
    for &point in points.iter().rev().skip(1) {
        while hull.len() > lower && !turns_left(hull, point) {
            hull.pop();
        }
        hull.push(point);
    }
    let next = hull.iter().skip(1).chain(hull.first());
    hull.iter()
        .zip(next)
        .map(|(a, b)| a.perp_dot(*b))
        .sum::<f64>()
        * 0.5
}

#[cfg(test)]
mod tests {
    use super::*;

    fn area(points: &[(f64, f64)]) -> f64 {
        let mut scratch = FootprintScratch {
            points: points.iter().map(|&p| p.into()).collect(),
            hull: Vec::new(),
        };
        hull_area(&mut scratch)
    }

    #[test]
    fn hulls_have_the_areas_of_their_figures() {
        let square = [
            (0.0, 0.0),
            (2.0, 2.0),
            (0.0, 2.0),
            (1.0, 1.0),
            (2.0, 0.0),
            (1.0, 0.0),
        ];
        assert_eq!(area(&square), 4.0);
        assert_eq!(area(&[(0.0, 0.0), (3.0, 0.0), (0.0, 4.0), (0.0, 4.0)]), 6.0);
        // This is a hexagon of side 1.
        let hexagon: Vec<_> = (0..6)
            .map(|corner| f64::from(corner) * std::f64::consts::FRAC_PI_3)
            .map(|angle| (angle.cos(), angle.sin()))
            .collect();
        assert!((area(&hexagon) - 1.5 * 3.0_f64.sqrt()).abs() < 1e-12);
        // These figures have no area; the first has no points.
        for flat in [
            &[][..],
            &[(1.0, 2.0)],
            &[(0.0, 0.0), (1.0, 1.0), (2.0, 2.0)],
        ] {
            assert_eq!(area(flat), 0.0, "{flat:?}");
        }
    }
}
