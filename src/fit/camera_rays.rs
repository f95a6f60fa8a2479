//! Finds where rays through a camera's image may meet the bounds of receivers, and how much of a
//! light's map a pixel covers there.

use std::ops::RangeInclusive;

use glam::{DVec2, DVec3};

use crate::Aabb;
use crate::fit::camera::CameraFrustum;
use crate::fit::point_grid::PointGrid;

/// Is the height in pixels of the image for which errors are predicted.
const IMAGE_HEIGHT_PIXELS: f64 = 720.0;

/// Is the density of shadow edges that is assumed for a pixel of mean size, in pixels of edges per
/// pixel: the mean over eight test pictures, which have from 0.005 to 0.045.
const MEAN_EDGES: f64 = 0.02;

/// Is the exponent with which that density grows with the world size of a pixel. It would be 0 if
/// shadows were as detailed as the image everywhere, and 1 if edges were equally dense everywhere
/// in the world.
const EDGES_EXPONENT: f64 = 2.0 / 3.0;

/// Is the factor by which a pixel counts less on a side of a receiver's bounds that faces away from
/// the light: of what lies behind that side, most faces away as well.
const AWAY: f64 = 0.25;

/// Is the least cosine of the angles between a surface and the directions to light and eye that
/// counts.
const LEAST_COSINE: f64 = 0.02;

/// Is the cosine for a surface whose direction is unknown.
const MEAN_COSINE: f64 = 0.5;

/// Holds the memory of the rays of a camera.
#[derive(Debug, Default)]
pub(crate) struct CameraRays {
    rays: Vec<Ray>,
    grid: PointGrid,
}

/// Is a ray through a camera's image, with what it has met so far.
#[derive(Clone, Copy, Debug)]
struct Ray {
    /// Is where it passes through the image, from 0 to 1 along x and y.
    place: DVec2,
    /// Chooses among the depths at which it may meet a receiver, from 0 to 1.
    choice: f64,
    start: DVec3,
    per_depth: DVec3,
    /// Is the depth of the nearest flat bounds, or the far end of the camera's view.
    end: f64,
    /// Is the axis across which these bounds are met; the next field is their outward normal.
    end_axis: usize,
    normal: Option<DVec3>,
    /// Is the depth at which the first of the other bounds begin, and at which the last end.
    first: f64,
    last: f64,
}

/// Is a point at which a ray may meet a receiver.
#[derive(Clone, Copy, Debug)]
pub(crate) struct RayHit {
    pub render: DVec3,
    /// Is the direction of the ray, of any length.
    direction: DVec3,
    /// Is the normal of the side of the bounds that is met; `None` where the surface may be
    /// anywhere in them.
    normal: Option<DVec3>,
    /// Is the world height of a pixel across the view.
    pub height: f64,
}

impl CameraRays {
    /// Returns the points at which the rays at some `indices` meet what the camera sees. The rays
    /// are the same in all frames; `seen` returns the bounds of what the camera sees.
    ///
    /// Boxes look for the rays that may meet them, since there are far fewer rays than pairs of a
    /// ray and a box.
    pub(super) fn cast<'a, I: Iterator<Item = &'a Aabb>>(
        &mut self,
        camera: &CameraFrustum,
        indices: RangeInclusive<u32>,
        seen: impl Fn() -> I,
    ) -> impl Iterator<Item = RayHit> {
        let Self { rays, grid } = self;
        rays.clear();
        rays.extend(indices.map(|index| Ray::new(camera, index)));
        grid.fill(rays.iter().map(|ray| ray.place));
        let (near, _) = camera.depth_range();
        let near = near.max(0.0);
        for bounds in seen().filter(|bounds| is_flat(bounds)) {
            let (min, max) = camera.image_rect(bounds);
            for ray in grid.near(min, max) {
                rays[ray].meet_flat(bounds, near);
            }
        }
        for bounds in seen().filter(|bounds| !is_flat(bounds)) {
            let (min, max) = camera.image_rect(bounds);
            for ray in grid.near(min, max) {
                rays[ray].meet_solid(bounds, near);
            }
        }
        rays.iter().filter_map(move |ray| {
            let (depth, normal) = ray.depth_and_normal()?;
            Some(RayHit {
                render: ray.start + ray.per_depth * depth,
                direction: ray.per_depth,
                normal,
                height: camera.image_height(depth) / IMAGE_HEIGHT_PIXELS,
            })
        })
    }
}

impl RayHit {
    /// Returns the world side of a square across the light with the area that a pixel covers there.
    /// `toward_light` has unit length.
    pub(super) fn pixel_across(&self, toward_light: DVec3) -> f64 {
        let cosine = |direction: DVec3| match self.normal {
            None => MEAN_COSINE,
            Some(normal) => normal.dot(direction).abs().max(LEAST_COSINE),
        };
        let area_factor = cosine(toward_light) / cosine(self.direction.normalize());
        self.height * area_factor.sqrt()
    }

    /// Returns the factor by which the pixel counts, for the side of the bounds that it is on.
    pub(super) fn facing(&self, toward_light: DVec3) -> f64 {
        match self.normal {
            Some(normal) if normal.dot(toward_light) < 0.0 => AWAY,
            _ => 1.0,
        }
    }
}

/// Returns the density of shadow edges that is assumed at least where a shadow can fall, in pixels
/// of edges per pixel. `mean_pixel` is the mean of all sizes like `pixel`.
pub(crate) fn assumed_edges(pixel: f64, mean_pixel: f64) -> f64 {
    MEAN_EDGES * (pixel / mean_pixel).powf(EDGES_EXPONENT)
}

impl Ray {
    /// Makes the ray at `index` of those that are spread over the image.
    fn new(camera: &CameraFrustum, index: u32) -> Self {
        // These are the fractions of the multiples of three irrational numbers, which fill a cube
        // most evenly (Roberts 2018, "The Unreasonable Effectiveness of Quasirandom Sequences").
        const STEPS: DVec3 = DVec3::new(
            0.819_172_513_396_164_4,
            0.671_043_606_703_789_3,
            0.549_700_477_901_970_9,
        );
        let place = (STEPS * f64::from(index)).fract();
        let (start, per_depth) = camera.ray(place.truncate());
        Self {
            place: place.truncate(),
            choice: place.z,
            start,
            per_depth,
            end: camera.depth_range().1,
            end_axis: 0,
            normal: None,
            first: f64::INFINITY,
            last: f64::NEG_INFINITY,
        }
    }

    /// Returns, for each axis, the depth at which the ray enters the slab of the bounds, and the
    /// depth at which it leaves them; `None` where it does not meet them beyond `near`.
    fn chord(&self, bounds: &Aabb, near: f64) -> Option<(DVec3, f64)> {
        let inverse = self.per_depth.recip();
        let low = (bounds.min.as_dvec3() - self.start) * inverse;
        let high = (bounds.max.as_dvec3() - self.start) * inverse;
        let (enter, leave) = (low.min(high), low.max(high));
        let meets = enter.max_element() <= leave.min_element() && leave.min_element() >= near;
        meets.then_some((enter, leave.min_element()))
    }

    /// Ends the ray where it meets flat bounds, which the surface fills.
    fn meet_flat(&mut self, bounds: &Aabb, near: f64) {
        let Some((enter, _)) = self.chord(bounds, near) else {
            return;
        };
        let (depth, axis) = (enter.max_element(), enter.max_position());
        // Of several at the same depth, the one across the first axis counts.
        let is_first = depth < self.end || (depth == self.end && axis < self.end_axis);
        if depth >= near && is_first {
            let mut normal = DVec3::ZERO;
            normal[axis] = -self.per_depth[axis].signum();
            (self.end, self.end_axis) = (depth, axis);
            self.normal = Some(normal);
        }
    }

    /// Extends the depths at which the surface in other bounds may be met, up to the end.
    fn meet_solid(&mut self, bounds: &Aabb, near: f64) {
        if let Some((enter, leave)) = self.chord(bounds, near) {
            let enter = enter.max_element().max(near);
            if enter < self.end {
                self.first = self.first.min(enter);
                self.last = self.last.max(leave.min(self.end));
            }
        }
    }

    /// Returns the depth at which the ray meets a receiver, with the normal of the side that it
    /// meets if the surface is known to be there. In bounds that are not flat the surface may be
    /// anywhere, most likely toward the end.
    fn depth_and_normal(&self) -> Option<(f64, Option<DVec3>)> {
        let within = |choice: f64| {
            let (first, last) = (self.first, self.last);
            (first <= last && last.is_finite())
                .then(|| (first + (last - first) * choice.sqrt(), None))
        };
        let Some(normal) = self.normal else {
            return within(self.choice);
        };
        let surface = (self.end, Some(normal));
        if self.choice < 0.5 {
            return Some(surface);
        }
        within(2.0 * self.choice - 1.0).or(Some(surface))
    }
}

/// Returns whether the surface in bounds must be where the bounds are.
fn is_flat(bounds: &Aabb) -> bool {
    let size = bounds.max - bounds.min;
    size.min_element() <= 1e-3 * size.max_element()
}
