//! Finds what each camera sees of the receivers, once a frame; the result is then divided among the
//! cascades.

use glam::DVec3;

use crate::Aabb;
use crate::fit::axes::{LightBox, LightSpace};
use crate::fit::boxes::Boxes;
use crate::fit::camera::CameraFrustum;
use crate::fit::region::{HalfSpaces, Relation};

/// Is the part of a receiver's bounds that counts.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SeenReceiver {
    /// Bounds the whole receiver.
    pub bounds: Aabb,
    /// Is the least corner of the box around the part, in render space.
    pub min: DVec3,
    /// Is the greatest corner.
    pub max: DVec3,
    /// Is the index of the caster whose surface receives, if the receiver casts as well.
    pub caster: Option<u32>,
}

impl SeenReceiver {
    /// Returns a receiver that counts as a whole.
    pub(super) fn whole(bounds: &Aabb, caster: Option<u32>) -> Self {
        Self {
            bounds: *bounds,
            min: bounds.min.as_dvec3(),
            max: bounds.max.as_dvec3(),
            caster,
        }
    }

    /// Returns the part of that side of the bounds, across `axis`, that faces the light; `None`
    /// where no side does or nothing of it counts.
    pub(super) fn lit_side(&self, axis: usize, toward_light: DVec3) -> Option<(DVec3, DVec3)> {
        let (mut min, mut max) = (self.min, self.max);
        if toward_light[axis] > 0.0 && max[axis] == f64::from(self.bounds.max[axis]) {
            min[axis] = max[axis];
        } else if toward_light[axis] < 0.0 && min[axis] == f64::from(self.bounds.min[axis]) {
            max[axis] = min[axis];
        } else {
            return None;
        }
        Some((min, max))
    }
}

/// Is a receiver of which one of the cameras sees a part.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Seen {
    /// Is the index of the frame's camera that sees it.
    camera: usize,
    bounds: Aabb,
    /// States that all of it is in the camera's volume.
    wholly: bool,
    /// Is the depth along the view at which the part that is seen begins; the next field is the
    /// depth at which it ends.
    depth_near: f64,
    depth_far: f64,
}

impl Seen {
    /// Returns the bounds of the whole receiver, if the camera at `index` sees something of it.
    pub(super) fn bounds_of(&self, index: usize) -> Option<&Aabb> {
        (self.camera == index).then_some(&self.bounds)
    }

    /// Returns whether the camera at `index` sees something of it between two depths.
    fn reaches(&self, index: usize, (depth_near, depth_far): (f64, f64)) -> bool {
        self.camera == index && self.depth_near <= depth_far && self.depth_far >= depth_near
    }

    /// Returns whether all of it is seen, between the two depths.
    fn is_within(&self, (depth_near, depth_far): (f64, f64)) -> bool {
        self.wholly && self.depth_near >= depth_near && self.depth_far <= depth_far
    }
}

/// Holds the bounds of all that is seen, in render space and in depth along the view.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct SeenBounds {
    pub render_min: DVec3,
    pub render_max: DVec3,
    pub depth_near: f64,
    pub depth_far: f64,
}

impl SeenBounds {
    pub(super) const NOTHING: Self = Self {
        render_min: DVec3::INFINITY,
        render_max: DVec3::NEG_INFINITY,
        depth_near: f64::INFINITY,
        depth_far: f64::NEG_INFINITY,
    };

    /// Returns the bounds of some boxes as a whole, with no depths along a view.
    pub(super) fn of_boxes<'a>(boxes: impl IntoIterator<Item = &'a Aabb>) -> Self {
        let mut all = Self::NOTHING;
        for bounds in boxes.into_iter().filter(|bounds| !bounds.is_empty()) {
            all.render_min = all.render_min.min(bounds.min.as_dvec3());
            all.render_max = all.render_max.max(bounds.max.as_dvec3());
        }
        all
    }

    /// Returns whether a shadow of `caster` can fall on anything visible. A point is shadowed by a
    /// point of the caster further along the way to the light, so on each world axis the caster
    /// must reach beyond the receivers' near end in the light's direction. A flat floor under
    /// everything else fails this (it reaches just as far as the lowest receiver: itself), and
    /// neither widens the light-space bounds nor is drawn.
    pub(super) fn can_be_shadowed_by(&self, caster: &Aabb, toward_light: DVec3) -> bool {
        let (low, high) = (caster.min.as_dvec3(), caster.max.as_dvec3());
        (0..3).all(|axis| {
            let toward = toward_light[axis];
            if toward > 0.0 {
                high[axis] > self.render_min[axis]
            } else if toward < 0.0 {
                low[axis] < self.render_max[axis]
            } else {
                high[axis] >= self.render_min[axis] && low[axis] <= self.render_max[axis]
            }
        })
    }

    /// Returns the bounds of what is in either of two.
    pub(super) fn union(&self, other: &Self) -> Self {
        Self {
            render_min: self.render_min.min(other.render_min),
            render_max: self.render_max.max(other.render_max),
            depth_near: self.depth_near.min(other.depth_near),
            depth_far: self.depth_far.max(other.depth_far),
        }
    }

    fn include(&mut self, seen: &Seen, render_min: DVec3, render_max: DVec3) {
        self.render_min = self.render_min.min(render_min);
        self.render_max = self.render_max.max(render_max);
        self.depth_near = self.depth_near.min(seen.depth_near);
        self.depth_far = self.depth_far.max(seen.depth_far);
    }
}

/// Holds the surfaces on which shadows are looked up in a frame.
#[derive(Clone, Copy)]
pub(crate) struct Receivers<'a> {
    /// Holds the bounds, in render space, of those that do not cast.
    pub given: &'a [Aabb],
    /// Holds the bounds of those that may cast, by their indices as casters.
    pub casters: Boxes<'a>,
}

impl<'a> Receivers<'a> {
    /// Calls `meet` with the bounds of each receiver and the index of the caster whose surface it
    /// is, if it is one's, as [`Boxes::walk`] does.
    pub(crate) fn walk<S>(
        &self,
        state: &mut S,
        enters: impl FnMut(&S, &Aabb) -> bool,
        mut meet: impl FnMut(&mut S, Option<u32>, &'a Aabb),
    ) {
        for bounds in self.given.iter().filter(|bounds| !bounds.is_empty()) {
            meet(state, None, bounds);
        }
        self.casters.walk(state, enters, |state, index, bounds| {
            meet(state, Some(index), bounds);
        });
    }

    /// Returns the bounds that are not empty, with the casters whose surfaces they are.
    pub(crate) fn iter(&self) -> impl Iterator<Item = (&'a Aabb, Option<u32>)> + use<'a> {
        let given = self.given.iter().filter(|bounds| !bounds.is_empty());
        let casters = self.casters.iter();
        let casters = casters.map(|(index, bounds)| (bounds, Some(index)));
        given.map(|bounds| (bounds, None)).chain(casters)
    }
}

/// Holds what cameras see, in lists that are reused from frame to frame.
#[derive(Debug, Default)]
pub(crate) struct SeenLists {
    /// Holds the receivers that each camera sees a part of.
    pub seen: Vec<Seen>,
    /// Holds the parts that count: what the cameras see, or what is in a region without a camera.
    pub parts: Vec<SeenReceiver>,
}

impl SeenLists {
    /// Fills the lists with the receivers that each of the cameras sees a part of, and returns the
    /// bounds of what they see together.
    pub(super) fn find(
        &mut self,
        cameras: &[CameraFrustum],
        receivers: Receivers<'_>,
    ) -> SeenBounds {
        self.seen.clear();
        self.parts.clear();
        let mut all = SeenBounds::NOTHING;
        for camera in cameras.iter().enumerate() {
            self.find_through(camera, receivers, &mut all);
        }
        all
    }

    /// Fills the lists with all of the receivers, seen by no camera.
    pub(super) fn set_whole(&mut self, receivers: Receivers<'_>) {
        self.seen.clear();
        self.parts.clear();
        let whole = receivers.iter();
        self.parts
            .extend(whole.map(|(bounds, caster)| SeenReceiver::whole(bounds, caster)));
    }

    fn find_through(
        &mut self,
        (index, camera): (usize, &CameraFrustum),
        receivers: Receivers<'_>,
        all: &mut SeenBounds,
    ) {
        let enters = |_: &_, around: &Aabb| !camera.planes.surely_misses(around);
        receivers.walk(&mut (self, all), enters, |(lists, all), caster, bounds| {
            let mut receiver = SeenReceiver::whole(bounds, caster);
            let mut part = Seen {
                camera: index,
                bounds: *bounds,
                wholly: false,
                depth_near: f64::INFINITY,
                depth_far: f64::NEG_INFINITY,
            };
            match camera.planes.relation(bounds) {
                Relation::Outside => return,
                Relation::Inside => {
                    let middle = camera.depth((receiver.min + receiver.max) * 0.5);
                    let half = (receiver.max - receiver.min) * 0.5;
                    let reach = camera.forward().abs().dot(half);
                    part.wholly = true;
                    part.depth_near = middle - reach;
                    part.depth_far = middle + reach;
                }
                Relation::Across => {
                    (receiver.min, receiver.max) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
                    camera.planes.visit_vertices(bounds, |vertex| {
                        receiver.min = receiver.min.min(vertex);
                        receiver.max = receiver.max.max(vertex);
                        let depth = camera.depth(vertex);
                        part.depth_near = part.depth_near.min(depth);
                        part.depth_far = part.depth_far.max(depth);
                    });
                    if part.depth_near > part.depth_far {
                        return;
                    }
                }
            }
            all.include(&part, receiver.min, receiver.max);
            lists.seen.push(part);
            lists.parts.push(receiver);
        });
    }
}

/// Returns the light-space box of what the camera at `index` sees between two depths; it is empty
/// if that is nothing.
pub(crate) fn light_box_between(
    (index, camera): (usize, &CameraFrustum),
    seen: &[Seen],
    between: (f64, f64),
    space: &LightSpace,
) -> LightBox {
    let slice = camera.slice(between.0, between.1);
    let mut covered = LightBox::EMPTY;
    for part in seen.iter().filter(|part| part.reaches(index, between)) {
        let whole = space.bounds(&part.bounds);
        if covered.surely_holds(&whole) {
            continue;
        }
        if part.is_within(between) {
            covered.union(&whole);
        } else {
            slice.visit_vertices(&part.bounds, |vertex| covered.include(space.point(vertex)));
        }
    }
    covered
}

/// Calls `visit` with points whose convex hull is, for each part that the camera at `index` sees
/// between two depths, its intersection with `over`, the sides of a rectangle across the light.
/// Parts for whose bounds `counts` returns false are left out.
pub(crate) fn visit_between(
    (index, camera): (usize, &CameraFrustum),
    seen: &[Seen],
    between: (f64, f64),
    over: &HalfSpaces,
    counts: impl Fn(&Aabb) -> bool,
    mut visit: impl FnMut(DVec3),
) {
    let mut region = camera.slice(between.0, between.1);
    over.as_slice().iter().for_each(|side| region.push(*side));
    for part in seen.iter().filter(|part| part.reaches(index, between)) {
        if !counts(&part.bounds) {
            continue;
        }
        let part_region = if part.is_within(between) {
            over
        } else {
            &region
        };
        part_region.visit_vertices(&part.bounds, &mut visit);
    }
}
