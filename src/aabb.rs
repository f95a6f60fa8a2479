//! Defines axis-aligned boxes in render space.

use glam::{DVec3, Mat4, Vec3};

/// Holds an axis-aligned bounding box in render space (f32, in the engine's unit).
///
/// A box with `min > max` on any axis is *empty*: it contains nothing, and fitting and culling
/// ignore it. A box with a NaN is *broken*. A caster or receiver whose box has a NaN or, without
/// being empty, an infinite corner is left out of the frame and named by
/// [`ShadowFrame::broken_bounds`](crate::ShadowFrame::broken_bounds). Where a box is too small,
/// shadows of the geometry outside it are missing; a box that is too large only costs resolution
/// and draws.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Aabb {
    /// Is the least corner, in render space.
    pub min: Vec3,
    /// Is the greatest corner, in render space.
    pub max: Vec3,
}

impl Aabb {
    /// Contains nothing, and is the neutral element of [`Aabb::union`].
    pub const EMPTY: Self = Self {
        min: Vec3::INFINITY,
        max: Vec3::NEG_INFINITY,
    };

    /// Makes a box from its two corners. Corners in the wrong order give an empty box.
    pub const fn new(min: Vec3, max: Vec3) -> Self {
        Self { min, max }
    }

    /// Is the result of every operation that a NaN enters; no further union makes it valid again.
    pub(crate) const BROKEN: Self = Self {
        min: Vec3::NAN,
        max: Vec3::NAN,
    };

    /// Returns the smallest box that contains all `points`: [`Aabb::EMPTY`] if there are none, and
    /// a broken box if a coordinate is NaN.
    pub fn from_points(points: impl IntoIterator<Item = Vec3>) -> Self {
        points.into_iter().fold(Self::EMPTY, |bounds, point| {
            bounds.union(Self::new(point, point))
        })
    }

    /// Returns the smallest box that contains both boxes, or a broken box if either is broken.
    pub fn union(self, other: Self) -> Self {
        // `min` and `max` of a number and a NaN return the number or the NaN, depending on the
        // order.
        if self.is_nan() || other.is_nan() {
            return Self::BROKEN;
        }
        Self {
            min: self.min.min(other.min),
            max: self.max.max(other.max),
        }
    }

    /// Returns the bounds of the eight transformed corners, which contain the transformed geometry
    /// for every affine `target_from_source`. An empty box stays empty. An infinite box stays
    /// infinite, on all axes. The result is broken if this box is broken or the matrix makes a
    /// corner NaN.
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

    /// Returns whether `min > max` on some axis and no coordinate is NaN. A broken box is not
    /// empty; [`Aabb::is_finite`] returns false for it.
    pub fn is_empty(&self) -> bool {
        self.min.cmpgt(self.max).any() && !self.is_nan()
    }

    /// Returns whether every coordinate is finite. It is false for [`Aabb::EMPTY`].
    pub fn is_finite(&self) -> bool {
        self.min.is_finite() && self.max.is_finite()
    }

    fn is_nan(&self) -> bool {
        self.min.is_nan() || self.max.is_nan()
    }

    /// Returns the smallest box of f32 corners that holds the box of f64 corners from `min` to
    /// `max`.
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

    /// Returns corner `index` in `0..8`: bit 0 selects x, bit 1 y and bit 2 z, and a set bit
    /// selects `max`.
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
