//! Finds what each camera sees of the receivers, once a frame; the result is then divided among the cascades.

use glam::DVec3;

use crate::Aabb;
use crate::fit::axes::{LightAxes, LightBox};
use crate::fit::camera::CameraFrustum;
use crate::fit::region::Relation;

/// Is a receiver of which one of the cameras sees a part.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Seen {
    /// Is the index of the frame's camera that sees it.
    camera: usize,
    bounds: Aabb,
    /// States that all of it is in the camera's volume.
    wholly: bool,
    /// Is the depth along the view at which the part that is seen begins; the next field is the depth at which it ends.
    depth_near: f64,
    depth_far: f64,
}

/// Holds the bounds of all that is seen, in render space and in depth along the view.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SeenBounds {
    pub render_min: DVec3,
    pub render_max: DVec3,
    pub depth_near: f64,
    pub depth_far: f64,
}

impl SeenBounds {
    pub const NOTHING: Self = Self {
        render_min: DVec3::INFINITY,
        render_max: DVec3::NEG_INFINITY,
        depth_near: f64::INFINITY,
        depth_far: f64::NEG_INFINITY,
    };

    /// Returns the bounds of some boxes as a whole, with no depths along a view.
    pub fn of_boxes<'a>(boxes: impl IntoIterator<Item = &'a Aabb>) -> Self {
        let mut all = Self::NOTHING;
        for bounds in boxes.into_iter().filter(|bounds| !bounds.is_empty()) {
            all.render_min = all.render_min.min(bounds.min.as_dvec3());
            all.render_max = all.render_max.max(bounds.max.as_dvec3());
        }
        all
    }

    fn include(&mut self, seen: &Seen, render_min: DVec3, render_max: DVec3) {
        self.render_min = self.render_min.min(render_min);
        self.render_max = self.render_max.max(render_max);
        self.depth_near = self.depth_near.min(seen.depth_near);
        self.depth_far = self.depth_far.max(seen.depth_far);
    }
}

/// Fills `seen` with the receivers that each of the cameras sees a part of, and returns the bounds of what they see
/// together.
pub(crate) fn find(
    cameras: &[CameraFrustum],
    receivers: &[Aabb],
    seen: &mut Vec<Seen>,
) -> SeenBounds {
    seen.clear();
    let mut all = SeenBounds::NOTHING;
    for (index, camera) in cameras.iter().enumerate() {
        find_through((index, camera), receivers, seen, &mut all);
    }
    all
}

fn find_through(
    (index, camera): (usize, &CameraFrustum),
    receivers: &[Aabb],
    seen: &mut Vec<Seen>,
    all: &mut SeenBounds,
) {
    for bounds in receivers.iter().filter(|bounds| !bounds.is_empty()) {
        let (min, max) = (bounds.min.as_dvec3(), bounds.max.as_dvec3());
        let mut part = Seen {
            camera: index,
            bounds: *bounds,
            wholly: false,
            depth_near: f64::INFINITY,
            depth_far: f64::NEG_INFINITY,
        };
        match camera.planes.relation(bounds) {
            Relation::Outside => continue,
            Relation::Inside => {
                let middle = camera.depth((min + max) * 0.5);
                let reach = camera.forward().abs().dot((max - min) * 0.5);
                part.wholly = true;
                part.depth_near = middle - reach;
                part.depth_far = middle + reach;
                all.include(&part, min, max);
            }
            Relation::Across => {
                let (mut part_min, mut part_max) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
                camera.planes.visit_vertices(bounds, |vertex| {
                    part_min = part_min.min(vertex);
                    part_max = part_max.max(vertex);
                    let depth = camera.depth(vertex);
                    part.depth_near = part.depth_near.min(depth);
                    part.depth_far = part.depth_far.max(depth);
                });
                if part.depth_near > part.depth_far {
                    continue;
                }
                all.include(&part, part_min, part_max);
            }
        }
        seen.push(part);
    }
}

/// Returns the light-space box of what the camera at `index` sees between two depths; it is empty if that is nothing.
pub(crate) fn light_box_between(
    (index, camera): (usize, &CameraFrustum),
    seen: &[Seen],
    (depth_near, depth_far): (f64, f64),
    axes: &LightAxes,
    origin: DVec3,
) -> LightBox {
    let slice = camera.slice(depth_near, depth_far);
    let mut covered = LightBox::EMPTY;
    let overlapping = seen.iter().filter(|part| {
        part.camera == index && part.depth_near <= depth_far && part.depth_far >= depth_near
    });
    for part in overlapping {
        if part.wholly && part.depth_near >= depth_near && part.depth_far <= depth_far {
            covered.union(&axes.light_box(&part.bounds, origin));
        } else {
            slice.visit_vertices(&part.bounds, |vertex| {
                covered.include(axes.light_from_world * (origin + vertex));
            });
        }
    }
    covered
}
