//! Axis-aligned boxes in render space.

use glam::{Mat4, Vec3};

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

    /// The smallest box that holds all `points`; [`Aabb::EMPTY`] for none.
    pub fn from_points(points: impl IntoIterator<Item = Vec3>) -> Self {
        points.into_iter().fold(Self::EMPTY, |bounds, point| Self {
            min: bounds.min.min(point),
            max: bounds.max.max(point),
        })
    }

    /// The smallest box that holds both.
    pub fn union(self, other: Self) -> Self {
        Self {
            min: self.min.min(other.min),
            max: self.max.max(other.max),
        }
    }

    /// The box of the eight transformed corners: holds the transformed geometry for every affine `target_from_source`.
    pub fn transformed(self, target_from_source: &Mat4) -> Self {
        if self.is_empty() {
            return Self::EMPTY;
        }
        Self::from_points(
            (0..8).map(|corner| target_from_source.transform_point3(self.corner(corner))),
        )
    }

    /// True where `min > max` on some axis. NaN corners are not empty: [`Aabb::is_finite`] is what tells them.
    pub fn is_empty(&self) -> bool {
        self.min.cmpgt(self.max).any()
    }

    /// True where every coordinate is finite.
    pub fn is_finite(&self) -> bool {
        self.min.is_finite() && self.max.is_finite()
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
