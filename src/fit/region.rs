//! Computes the exact vertices of a convex region cut by a box.
//!
//! The hull of (region ∩ box) is spanned by the box's edges inside the region and the region's
//! edges inside the box. Each is a line clipped by half-spaces: no polygon lists, no allocation,
//! and a region may be unbounded (an infinite far plane).

use glam::DVec3;

use crate::Aabb;

/// Is the set of points with `normal · p + offset ≥ 0`; `normal` has unit length, so the left side
/// is a distance.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct HalfSpace {
    pub normal: DVec3,
    pub offset: f64,
}

impl HalfSpace {
    fn distance(&self, point: DVec3) -> f64 {
        self.normal.dot(point) + self.offset
    }
}

/// Is the largest number of half-spaces of a region: the six sides of a box, or of a camera's clip
/// volume, and its distance limit, with either the two ends of a slice and the four sides of a map
/// rectangle, or the five sides of a local light's view.
const CAPACITY: usize = 13;

/// Is an intersection of at most [`CAPACITY`] half-spaces. An empty list is all of space.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct HalfSpaces {
    planes: [HalfSpace; CAPACITY],
    count: usize,
}

/// Tells whether a box is outside a region, inside it or across its boundary.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Relation {
    Outside,
    Inside,
    Across,
}

/// Is a line `point + t * direction` limited to `t` in `[from, to]`.
#[derive(Clone, Copy)]
struct Segment {
    point: DVec3,
    direction: DVec3,
    from: f64,
    to: f64,
}

impl Segment {
    /// Keeps the part inside `plane` and returns true, or returns false if there is no such part.
    /// `slack` is a distance by which rounding is forgiven.
    fn clip(&mut self, plane: &HalfSpace, slack: f64) -> bool {
        let rate = plane.normal.dot(self.direction);
        let distance = plane.distance(self.point) + slack;
        if rate == 0.0 {
            return distance >= 0.0;
        }
        let crossing = -distance / rate;
        if rate > 0.0 {
            self.from = self.from.max(crossing);
        } else {
            self.to = self.to.min(crossing);
        }
        self.from <= self.to
    }

    /// Keeps the part inside the box and returns true, or returns false if there is no such part.
    fn clip_to_box(&mut self, min: DVec3, max: DVec3, slack: f64) -> bool {
        (0..3).all(|axis| {
            let mut normal = DVec3::ZERO;
            normal[axis] = 1.0;
            let low = HalfSpace {
                normal,
                offset: -min[axis],
            };
            let high = HalfSpace {
                normal: -normal,
                offset: max[axis],
            };
            self.clip(&low, slack) && self.clip(&high, slack)
        })
    }
}

/// Is a box as it is compared with half-spaces.
struct Extent {
    center: DVec3,
    half: DVec3,
    rounding: f64,
}

impl Extent {
    fn new(bounds: &Aabb) -> Self {
        let (min, max) = (bounds.min.as_dvec3(), bounds.max.as_dvec3());
        Self {
            center: (min + max) * 0.5,
            half: (max - min) * 0.5,
            // Each of the distances is a sum of four products, which are rounded by an ulp or two.
            rounding: 32.0 * f64::EPSILON * min.abs().max(max.abs()).element_sum(),
        }
    }

    fn distance(&self, plane: &HalfSpace) -> f64 {
        plane.distance(self.center)
    }

    /// Returns how far the box extends from its middle across the plane.
    fn reach(&self, plane: &HalfSpace) -> f64 {
        plane.normal.abs().dot(self.half)
    }

    /// Returns more than distances may be off.
    fn slack(&self, plane: &HalfSpace) -> f64 {
        self.rounding + 32.0 * f64::EPSILON * plane.offset.abs()
    }
}

impl HalfSpaces {
    /// Returns the inside of a box.
    pub(crate) fn of_box(bounds: &Aabb) -> Self {
        let mut planes = Self::default();
        let (min, max) = (bounds.min.as_dvec3(), bounds.max.as_dvec3());
        for (axis, normal) in [DVec3::X, DVec3::Y, DVec3::Z].into_iter().enumerate() {
            planes.push(HalfSpace {
                normal,
                offset: -min[axis],
            });
            planes.push(HalfSpace {
                normal: -normal,
                offset: max[axis],
            });
        }
        planes
    }

    pub(crate) fn push(&mut self, plane: HalfSpace) {
        self.planes[self.count] = plane;
        self.count += 1;
    }

    pub(crate) fn as_slice(&self) -> &[HalfSpace] {
        &self.planes[..self.count]
    }

    /// Returns how `bounds` (not empty) relates to the region. A box near an edge of the region may
    /// count as across although it is outside.
    pub(crate) fn relation(&self, bounds: &Aabb) -> Relation {
        let center = (bounds.min.as_dvec3() + bounds.max.as_dvec3()) * 0.5;
        let half = (bounds.max.as_dvec3() - bounds.min.as_dvec3()) * 0.5;
        let mut relation = Relation::Inside;
        for plane in self.as_slice() {
            let distance = plane.distance(center);
            let reach = plane.normal.abs().dot(half);
            if distance < -reach {
                return Relation::Outside;
            }
            if distance < reach {
                relation = Relation::Across;
            }
        }
        relation
    }

    /// Returns whether a point is in the region.
    pub(crate) fn holds(&self, point: DVec3) -> bool {
        self.as_slice()
            .iter()
            .all(|plane| plane.distance(point) >= 0.0)
    }

    /// Returns whether the region surely has nothing of `around`, nor of any box in it as
    /// [`relation`](Self::relation) judges that one, whatever the rounding.
    pub(crate) fn surely_misses(&self, around: &Aabb) -> bool {
        let extent = Extent::new(around);
        let mut planes = self.as_slice().iter();
        planes.any(|plane| extent.distance(plane) < -extent.reach(plane) - extent.slack(plane))
    }

    /// Returns those of the half-spaces that may not hold all of `bounds`. The others cut nothing
    /// off the box, and none of their edges is in it.
    fn cutting(&self, bounds: &Aabb) -> Self {
        let extent = Extent::new(bounds);
        let mut cutting = Self::default();
        for plane in self.as_slice() {
            if extent.distance(plane) <= extent.reach(plane) + extent.slack(plane) {
                cutting.push(*plane);
            }
        }
        cutting
    }

    /// Calls `visit` with points whose convex hull is the region's intersection with `bounds`
    /// (never fewer; duplicates are possible). An empty intersection makes no call.
    pub(crate) fn visit_vertices(&self, bounds: &Aabb, mut visit: impl FnMut(DVec3)) {
        if bounds.is_empty() {
            return;
        }
        match self.relation(bounds) {
            Relation::Outside => {}
            Relation::Inside => (0..8).for_each(|c| visit(bounds.corner(c).as_dvec3())),
            Relation::Across => self.cutting(bounds).visit_cut(bounds, visit),
        }
    }

    fn visit_cut(&self, bounds: &Aabb, mut visit: impl FnMut(DVec3)) {
        let (min, max) = (bounds.min.as_dvec3(), bounds.max.as_dvec3());
        // This is a few ulps of the largest coordinate: an edge in a plane of the region must not
        // be lost to rounding.
        let slack = 16.0 * f64::EPSILON * min.abs().max(max.abs()).max_element();
        // Points are clamped, so that a flat box yields points that are exactly as flat.
        let mut visit_segment = |segment: Segment| {
            visit((segment.point + segment.direction * segment.from).clamp(min, max));
            visit((segment.point + segment.direction * segment.to).clamp(min, max));
        };
        for corner in 0..8usize {
            for axis in 0..3 {
                if corner >> axis & 1 == 1 {
                    continue;
                }
                let start = bounds.corner(corner).as_dvec3();
                let end = bounds.corner(corner | 1 << axis).as_dvec3();
                let mut edge = Segment {
                    point: start,
                    direction: end - start,
                    from: 0.0,
                    to: 1.0,
                };
                if self.as_slice().iter().all(|plane| edge.clip(plane, slack)) {
                    visit_segment(edge);
                }
            }
        }
        let planes = self.as_slice();
        for (i, first) in planes.iter().enumerate() {
            for (j, second) in planes.iter().enumerate().skip(i + 1) {
                let Some(mut edge) = meeting_line(first, second) else {
                    continue;
                };
                let others = planes
                    .iter()
                    .enumerate()
                    .filter(|(k, _)| *k != i && *k != j);
                if edge.clip_to_box(min, max, slack)
                    && others.map(|(_, p)| p).all(|plane| edge.clip(plane, slack))
                {
                    visit_segment(edge);
                }
            }
        }
    }
}

/// Returns the line in which two planes meet, or `None` where they are parallel to rounding.
fn meeting_line(first: &HalfSpace, second: &HalfSpace) -> Option<Segment> {
    let direction = first.normal.cross(second.normal);
    let length_squared = direction.length_squared();
    if length_squared < 1e-24 {
        return None;
    }
    let point = (direction.cross(second.normal) * first.offset
        + first.normal.cross(direction) * second.offset)
        / length_squared;
    Some(Segment {
        point,
        direction: direction / length_squared.sqrt(),
        from: f64::NEG_INFINITY,
        to: f64::INFINITY,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::Vec3;

    fn hull_box(region: &HalfSpaces, bounds: &Aabb) -> Option<(DVec3, DVec3)> {
        let mut found = None;
        region.visit_vertices(bounds, |p| {
            let (min, max) = found.unwrap_or((p, p));
            found = Some((p.min(min), p.max(max)));
        });
        found
    }

    fn half_space(normal: DVec3, offset: f64) -> HalfSpace {
        HalfSpace {
            normal: normal.normalize(),
            offset,
        }
    }

    #[test]
    fn a_diagonal_plane_cuts_a_cube_exactly() {
        let mut region = HalfSpaces::default();
        region.push(half_space(DVec3::new(1.0, 1.0, 0.0), -1.5 / 2.0_f64.sqrt()));
        let cube = Aabb::new(Vec3::ZERO, Vec3::ONE);
        let (min, max) = hull_box(&region, &cube).unwrap();
        assert!((min - DVec3::new(0.5, 0.5, 0.0)).length() < 1e-14);
        assert!((max - DVec3::ONE).length() < 1e-14);
    }

    #[test]
    fn a_region_inside_the_box_gives_its_own_vertices() {
        let mut region = HalfSpaces::default();
        for axis in [DVec3::X, DVec3::Y, DVec3::Z] {
            region.push(half_space(axis, 1.0));
            region.push(half_space(-axis, 2.0));
        }
        let bounds = Aabb::new(Vec3::splat(-10.0), Vec3::splat(10.0));
        let (min, max) = hull_box(&region, &bounds).unwrap();
        // The slack of the clip is 16 ulps of the box's largest coordinate, on each of three axes.
        let tolerance = 3.0 * 16.0 * f64::EPSILON * 10.0;
        assert!((min + DVec3::ONE).length() < tolerance);
        assert!((max - DVec3::splat(2.0)).length() < tolerance);
    }

    #[test]
    fn flat_boxes_and_misses() {
        let mut region = HalfSpaces::default();
        region.push(half_space(DVec3::X, -0.25));
        let flat = Aabb::new(Vec3::new(0.0, 0.0, 0.0), Vec3::new(1.0, 0.0, 1.0));
        let (min, max) = hull_box(&region, &flat).unwrap();
        assert!((min - DVec3::new(0.25, 0.0, 0.0)).length() < 1e-14);
        assert!((max - DVec3::new(1.0, 0.0, 1.0)).length() < 1e-14);
        let miss = Aabb::new(Vec3::splat(-2.0), Vec3::splat(0.0));
        assert!(hull_box(&region, &miss).is_none());
        assert!(hull_box(&region, &Aabb::EMPTY).is_none());
    }
}
