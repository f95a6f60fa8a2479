//! Defines the map rectangle of a directional light extruded without end toward the light: the
//! volume that casters must reach into to cast into the map.

use glam::{DVec2, DVec3};

use crate::Aabb;
use crate::fit::axes::LightSpace;
use crate::fit::map_rect::MapRect;
use crate::fit::region::{HalfSpace, HalfSpaces};

/// Is the volume over a map rectangle, prepared so that many boxes can be tested against it.
///
/// Seen along the light a box is a hexagon, whose sides run along the projected world axes. Two
/// convex figures in the plane are apart exactly if a normal of one's sides separates them
/// (Gottschalk et al. 1996): two normals of the rectangle, and three of the hexagon. The caller has
/// tested the rectangle's own already, with the box's interval in light space.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ExtrudedRect {
    center_render: DVec3,
    /// Is the world distance by which the centre may be off.
    center_error: f64,
    sides: [Side; 3],
}

/// Is a normal of the hexagon's sides, as a direction of render space, with the half-extent of the
/// rectangle along it.
#[derive(Clone, Copy, Debug)]
struct Side {
    normal: DVec3,
    normal_abs: DVec3,
    rect_reach: f64,
}

impl ExtrudedRect {
    pub(super) fn new(space: &LightSpace, rect: &MapRect) -> Self {
        let LightSpace { axes, origin } = space;
        let half = (rect.max() - rect.min) * 0.5;
        let center = rect.min + half;
        let center_world = axes.right() * center.x + axes.up() * center.y;
        let sides = [DVec3::X, DVec3::Y, DVec3::Z].map(|axis| {
            let along = DVec2::new(axes.right().dot(axis), axes.up().dot(axis));
            let across = along.perp();
            let normal = axes.right() * across.x + axes.up() * across.y;
            Side {
                normal,
                normal_abs: normal.abs(),
                rect_reach: across.abs().dot(half),
            }
        });
        Self {
            // Any point of the axis is as good: normals are perpendicular to the light.
            center_render: center_world - *origin,
            // The error is a few ulps of what was subtracted.
            center_error: 8.0 * f64::EPSILON * origin.length().max(center_world.length()),
            sides,
        }
    }

    /// Returns whether the box, seen along the light, overlaps the rectangle on all of the
    /// hexagon's normals.
    pub(super) fn meets(&self, bounds: &Aabb) -> bool {
        let (min, max) = (bounds.min.as_dvec3(), bounds.max.as_dvec3());
        let between = (min + max) * 0.5 - self.center_render;
        let half = (max - min) * 0.5;
        // This is what rounding may add: a few ulps of the coordinates.
        let slack =
            16.0 * f64::EPSILON * self.center_render.abs().max_element() + self.center_error;
        self.sides.iter().all(|side| {
            let reach = side.rect_reach + side.normal_abs.dot(half);
            side.normal.dot(between).abs() <= reach + slack
        })
    }
}

/// Adds the four sides of an extruded rectangle, from `min` to `max` across the light, to a region
/// of render space.
pub(crate) fn push_extruded_rect(
    region: &mut HalfSpaces,
    space: &LightSpace,
    (min, max): (DVec2, DVec2),
) {
    let LightSpace { axes, origin } = space;
    for (axis, low, high) in [(axes.right(), min.x, max.x), (axes.up(), min.y, max.y)] {
        let origin = axis.dot(*origin);
        region.push(HalfSpace {
            normal: axis,
            offset: origin - low,
        });
        region.push(HalfSpace {
            normal: -axis,
            offset: high - origin,
        });
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fit::axes::{LightAxes, LightBox};
    use glam::UVec2;

    /// Returns pseudo-random numbers in -1..1.
    fn noise(state: &mut u32) -> f64 {
        *state = state.wrapping_mul(747_796_405).wrapping_add(2_891_336_453);
        f64::from(*state) / f64::from(u32::MAX) * 2.0 - 1.0
    }

    /// Checks that interval and volume together agree with clipping the box by the four sides,
    /// except for boxes that touch within 1e-9, and that the volume culls some boxes that the
    /// interval lets pass.
    #[test]
    fn an_extruded_rect_meets_what_reaches_into_it() {
        let mut state = 1;
        let (mut inside, mut culled) = (0, 0);
        for _ in 0..8000 {
            let mut random = || noise(&mut state);
            let direction = DVec3::new(random(), random(), random());
            let axes = LightAxes::new(direction, DVec3::Y);
            let origin = DVec3::new(random(), random(), random()) * 1e4;
            let space = LightSpace { axes, origin };
            let middle = DVec3::new(random(), random(), random()) * 3.0;
            let half = DVec3::new(random(), random(), random()).abs() * 1.5;
            let bounds = Aabb::new((middle - half).as_vec3(), (middle + half).as_vec3());
            let center = (axes.light_from_world * origin).truncate();
            let texel = DVec2::new(random(), random()).abs() * 0.1 + 0.01;
            let rect = MapRect {
                min: center - texel * 16.0,
                texel,
                size_texels: UVec2::splat(32),
            };
            let light: LightBox = space.bounds(&bounds);
            let (min, max) = (rect.min, rect.max());
            let interval =
                light.min.truncate().cmple(max).all() && light.max.truncate().cmpge(min).all();
            let met = interval && ExtrudedRect::new(&space, &rect).meets(&bounds);
            let clipped = |grow: f64| {
                let grown = MapRect {
                    min: rect.min - grow,
                    texel: rect.texel + grow / 16.0,
                    ..rect
                };
                let mut region = HalfSpaces::default();
                push_extruded_rect(&mut region, &space, (grown.min, grown.max()));
                let mut any = false;
                region.visit_vertices(&bounds, |_| any = true);
                any
            };
            assert!(met || !clipped(-1e-9), "{bounds:?} reaches in");
            assert!(!met || clipped(1e-9), "{bounds:?} does not reach in");
            inside += usize::from(met);
            culled += usize::from(interval && !met);
        }
        assert!(inside > 400 && culled > 100, "{inside} {culled}");
    }
}
