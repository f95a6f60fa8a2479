//! Axis-aligned boxes in render space.

use glam::{DVec3, Mat4, Vec3};

/// An axis-aligned bounding box in render space (f32, the engine's unit).
///
/// A box with `min > max` on any axis is *empty*: it bounds nothing, and fitting and culling pass it over. A box that is too
/// small makes shadows vanish where the geometry leaves it; a box that is too large only costs resolution and draws.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Aabb {
    /// Least corner, render space.
    pub min: Vec3,
    /// Greatest corner, render space.
    pub max: Vec3,
}

impl Aabb {
    /// The box that bounds nothing; the neutral element of [`Aabb::union`].
    pub const EMPTY: Self = Self {
        min: Vec3::INFINITY,
        max: Vec3::NEG_INFINITY,
    };

    /// A box from its two corners. Corners in the wrong order give an empty box.
    pub const fn new(min: Vec3, max: Vec3) -> Self {
        Self { min, max }
    }

    /// What no geometry can mend: every box that a NaN went into.
    const BROKEN: Self = Self {
        min: Vec3::NAN,
        max: Vec3::NAN,
    };

    /// The smallest box that holds all `points`; [`Aabb::EMPTY`] for none, and a broken box where a coordinate is NaN.
    pub fn from_points(points: impl IntoIterator<Item = Vec3>) -> Self {
        points.into_iter().fold(Self::EMPTY, |bounds, point| {
            bounds.union(Self::new(point, point))
        })
    }

    /// The smallest box that holds both; a broken box where either is.
    pub fn union(self, other: Self) -> Self {
        // The minimum of a number and a NaN is one or the other, by order.
        if self.is_nan() || other.is_nan() {
            return Self::BROKEN;
        }
        Self {
            min: self.min.min(other.min),
            max: self.max.max(other.max),
        }
    }

    /// The box of the eight transformed corners: holds the transformed geometry for every affine `target_from_source`. An empty
    /// box stays empty. The box is broken where this one is, and where the matrix makes a corner NaN; an infinite box stays
    /// infinite, on all axes.
    pub fn transformed(self, target_from_source: &Mat4) -> Self {
        if self.is_empty() {
            return Self::EMPTY;
        }
        if !self.is_finite() && !self.is_nan() {
            return Self::new(Vec3::NEG_INFINITY, Vec3::INFINITY);
        }
        Self::from_points(
            (0..8).map(|corner| target_from_source.transform_point3(self.corner(corner))),
        )
    }

    /// True where `min > max` on some axis and no coordinate is NaN: a broken box is not empty, and [`Aabb::is_finite`] is what
    /// tells it.
    pub fn is_empty(&self) -> bool {
        self.min.cmpgt(self.max).any() && !self.is_nan()
    }

    /// True where every coordinate is finite.
    pub fn is_finite(&self) -> bool {
        self.min.is_finite() && self.max.is_finite()
    }

    fn is_nan(&self) -> bool {
        self.min.is_nan() || self.max.is_nan()
    }

    /// Returns the smallest box of f32 corners that holds the box of f64 corners from `min` to `max`.
    pub(crate) fn around(min: DVec3, max: DVec3) -> Self {
        let down = |value: f64| {
            let rounded = value as f32;
            if f64::from(rounded) > value {
                rounded.next_down()
            } else {
                rounded
            }
        };
        let up = |value: f64| {
            let rounded = value as f32;
            if f64::from(rounded) < value {
                rounded.next_up()
            } else {
                rounded
            }
        };
        Self {
            min: Vec3::new(down(min.x), down(min.y), down(min.z)),
            max: Vec3::new(up(max.x), up(max.y), up(max.z)),
        }
    }

    /// Corner `index` in `0..8`: bit 0 chooses x, bit 1 y, bit 2 z; a set bit takes `max`.
    pub(crate) fn corner(&self, index: usize) -> Vec3 {
        let pick = |axis: usize| {
            if index >> axis & 1 == 1 {
                self.max[axis]
            } else {
                self.min[axis]
            }
        };
        Vec3::new(pick(0), pick(1), pick(2))
    }
}
