//! Defines the world-fixed axes of a light and boxes in light space.

use glam::{DMat3, DVec3};

use crate::Aabb;

/// Holds the right-handed orthonormal axes of light space in world directions: x right, y up, z
/// *toward* the light.
///
/// They depend on the light's direction and on the world's up axis alone, never on a camera, so
/// that texels stay at their positions in the world.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct LightAxes {
    /// Has the rows right, up and toward-light: `light_from_world * v` gives light coordinates of a
    /// world direction.
    pub light_from_world: DMat3,
}

/// Is the cosine of the angle between light and up axis beyond which the up axis no longer orients
/// the map.
///
/// Below it the x axis is horizontal, so that ground seen under a grazing sun is a thin rectangle
/// along x. Above it (within 26 degrees of the zenith) the ground looks alike under every roll, and
/// the axes follow the world's own, along which ground and walls tend to be cut.
const UP_COSINE: f64 = 0.9;

impl LightAxes {
    /// Returns the axes for a light that shines along `direction_world` (any length but zero;
    /// finite), in a world whose up axis is `up_world`.
    pub(crate) fn new(direction_world: DVec3, up_world: DVec3) -> Self {
        let toward_light = -scaled_unit(direction_world);
        let up = scaled_unit(up_world);
        let reference = if toward_light.dot(up).abs() < UP_COSINE {
            up
        } else {
            horizontal_reference(up)
        };
        let right = reference.cross(toward_light).normalize();
        let map_up = toward_light.cross(right);
        Self {
            light_from_world: DMat3::from_cols(right, map_up, toward_light).transpose(),
        }
    }

    /// Returns the axes of a view that looks along `forward` with `up` upward. Both are unit
    /// vectors at right angles.
    pub(crate) fn looking(forward: DVec3, up: DVec3) -> Self {
        Self {
            light_from_world: DMat3::from_cols(forward.cross(up), up, -forward).transpose(),
        }
    }

    /// Returns the world direction of the light's x axis.
    pub(crate) fn right(&self) -> DVec3 {
        self.light_from_world.row(0)
    }

    /// Returns the world direction of the light's y axis.
    pub(crate) fn up(&self) -> DVec3 {
        self.light_from_world.row(1)
    }

    /// Returns the world direction toward the light.
    pub(crate) fn toward_light(&self) -> DVec3 {
        self.light_from_world.row(2)
    }
}

/// Is the light space of a frame: the axes of a light and the position of render space.
///
/// Light coordinates are absolute: those of a point stay the same while `origin` moves with a
/// camera.
#[derive(Clone, Copy, Debug)]
pub(crate) struct LightSpace {
    pub axes: LightAxes,
    /// Is the world position at which render space begins.
    pub origin: DVec3,
}

impl LightSpace {
    /// Returns the light coordinates of a point of render space.
    pub(crate) fn point(&self, point_render: DVec3) -> DVec3 {
        self.axes.light_from_world * (self.origin + point_render)
    }

    /// Returns z of the light coordinates of a point of render space; it grows toward the light.
    pub(crate) fn depth(&self, point_render: DVec3) -> f64 {
        self.axes.toward_light().dot(self.origin + point_render)
    }

    /// Returns the box in light space around a box in render space.
    pub(crate) fn bounds(&self, bounds: &Aabb) -> LightBox {
        let (min, max) = (bounds.min.as_dvec3(), bounds.max.as_dvec3());
        let center = self.point((min + max) * 0.5);
        let half = (max - min) * 0.5;
        let rows = self.axes.light_from_world;
        let extent = DVec3::new(
            rows.row(0).abs().dot(half),
            rows.row(1).abs().dot(half),
            rows.row(2).abs().dot(half),
        );
        LightBox {
            min: center - extent,
            max: center + extent,
        }
    }
}

/// Returns the unit vector of `v`, even where its squared length would overflow or vanish.
fn scaled_unit(v: DVec3) -> DVec3 {
    (v / v.abs().max_element()).normalize()
}

/// Returns the world axis that is most nearly perpendicular to `up`, made perpendicular to it.
/// Where two axes are equal, x is taken before z, and z before y.
fn horizontal_reference(up: DVec3) -> DVec3 {
    let a = up.abs();
    let axis = if a.x <= a.y && a.x <= a.z {
        DVec3::X
    } else if a.z <= a.y {
        DVec3::Z
    } else {
        DVec3::Y
    };
    axis - up * axis.dot(up)
}

/// Is an axis-aligned box in absolute light space (f64; z grows toward the light).
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct LightBox {
    pub min: DVec3,
    pub max: DVec3,
}

impl LightBox {
    pub(crate) const EMPTY: Self = Self {
        min: DVec3::INFINITY,
        max: DVec3::NEG_INFINITY,
    };

    pub(crate) fn is_empty(&self) -> bool {
        self.min.cmpgt(self.max).any()
    }

    /// Returns the box with every side `distance` farther out.
    pub(crate) fn grown(&self, distance: f64) -> Self {
        Self {
            min: self.min - distance,
            max: self.max + distance,
        }
    }

    /// Returns the box grown by more than the light coordinates of points in it may be off.
    fn with_rounding(&self) -> Self {
        let reach = self.min.abs().max(self.max.abs()).element_sum();
        self.grown(32.0 * f64::EPSILON * reach)
    }

    /// Returns whether the box holds all of `other`, whatever the rounding of points in it.
    pub(crate) fn surely_holds(&self, other: &Self) -> bool {
        self.surely_holds_xy(other) && self.surely_holds_depths(other)
    }

    /// Returns whether the box holds all of `other` as seen from the light.
    pub(crate) fn holds_xy(&self, other: &Self) -> bool {
        let (low, high) = (self.min.cmple(other.min), self.max.cmpge(other.max));
        low.x && low.y && high.x && high.y
    }

    /// Returns whether it does so as seen from the light, whatever the rounding of points in it.
    pub(crate) fn surely_holds_xy(&self, other: &Self) -> bool {
        self.holds_xy(&other.with_rounding())
    }

    /// Returns whether all depths of `other` are among its own, whatever the rounding.
    pub(crate) fn surely_holds_depths(&self, other: &Self) -> bool {
        let other = other.with_rounding();
        self.min.z <= other.min.z && self.max.z >= other.max.z
    }

    /// Returns the longer of its sides across the light; 0 for an empty box.
    pub(crate) fn widest_side(&self) -> f64 {
        (self.max - self.min).truncate().max_element().max(0.0)
    }

    /// Returns the distance from the origin of light space to the farthest corner.
    pub(crate) fn reach(&self) -> f64 {
        self.min.abs().max(self.max.abs()).length()
    }

    pub(crate) fn include(&mut self, point: DVec3) {
        self.min = self.min.min(point);
        self.max = self.max.max(point);
    }

    pub(crate) fn union(&mut self, other: &Self) {
        self.min = self.min.min(other.min);
        self.max = self.max.max(other.max);
    }

    /// Returns the part of the box, at all of its own depths, that is inside the sides of `other`
    /// as seen from the light, or `None` where there is none.
    pub(crate) fn intersection_xy(&self, other: &Self) -> Option<Self> {
        let min = self.min.max(other.min).with_z(self.min.z);
        let max = self.max.min(other.max).with_z(self.max.z);
        min.cmple(max).all().then_some(Self { min, max })
    }

    /// Returns whether the two boxes overlap as seen from the light (xy only; touching counts).
    pub(crate) fn overlaps_xy(&self, other: &Self) -> bool {
        self.min.x <= other.max.x
            && other.min.x <= self.max.x
            && self.min.y <= other.max.y
            && other.min.y <= self.max.y
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Checks that axes are orthonormal to 4 ulp, right-handed and toward the light, for every axis
    /// and a tiny angle off it.
    #[test]
    fn axes_are_orthonormal_for_every_direction() {
        let hair = 1e-7;
        let mut directions = Vec::new();
        for axis in [DVec3::X, DVec3::Y, DVec3::Z] {
            for sign in [-1.0, 1.0] {
                directions.push(axis * sign);
                for off in [DVec3::X, DVec3::Y, DVec3::Z] {
                    directions.push(axis * sign + off * hair);
                    directions.push(axis * sign - off * hair);
                }
            }
        }
        directions.push(DVec3::splat(1e-200));
        directions.push(DVec3::new(1e200, -1e200, 3e199));
        for up in [DVec3::Y, DVec3::Z, DVec3::new(1.0, 1.0, 1.0)] {
            for &direction in &directions {
                let axes = LightAxes::new(direction, up);
                let m = axes.light_from_world;
                let gram = m * m.transpose();
                let error = (gram - DMat3::IDENTITY).abs_diff_eq(DMat3::ZERO, 4.0 * f64::EPSILON);
                assert!(error, "{direction} {up}: {gram}");
                assert!((m.determinant() - 1.0).abs() <= 4.0 * f64::EPSILON);
                let unit = scaled_unit(direction);
                assert!((axes.toward_light() + unit).length() <= 4.0 * f64::EPSILON);
            }
        }
    }

    /// Checks that the fast box equals the box of the eight transformed corners.
    #[test]
    fn light_box_is_the_box_of_the_corners() {
        let space = LightSpace {
            axes: LightAxes::new(DVec3::new(0.3, -0.7, 0.2), DVec3::Y),
            origin: DVec3::new(1e5, -2e5, 3e5),
        };
        let bounds = Aabb::new(
            glam::Vec3::new(-1.0, 2.0, 3.0),
            glam::Vec3::new(4.0, 2.5, 9.0),
        );
        let fast = space.bounds(&bounds);
        let mut exact = LightBox::EMPTY;
        for corner in 0..8 {
            exact.include(space.point(bounds.corner(corner).as_dvec3()));
        }
        // At a magnitude of 4e5, three products and sums come to 8 ulps of f64.
        let tolerance = 8.0 * f64::EPSILON * 4e5;
        assert!(fast.min.abs_diff_eq(exact.min, tolerance));
        assert!(fast.max.abs_diff_eq(exact.max, tolerance));
    }
}
