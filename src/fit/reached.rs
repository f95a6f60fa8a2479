//! Finds what a local light reaches, once a frame; the result is then divided among its views.

use glam::DVec3;

use crate::Aabb;
use crate::fit::local_input::LocalInput;
use crate::fit::nearest::nearest_for;
use crate::fit::region::{HalfSpaces, Relation};

/// Holds the casters and receivers within a light's reach, in lists that are reused from frame to
/// frame.
#[derive(Debug, Default)]
pub(crate) struct Reached {
    /// Holds the casters that can shadow something.
    pub casters: Vec<ReachedCaster>,
    /// Holds the parts of the receivers that the light reaches.
    pub receivers: Vec<Aabb>,
}

/// Is a caster that a light reaches.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ReachedCaster {
    /// Is the caster's index in the engine's list.
    pub index: u32,
    /// Bounds the part of it within the box around the light's reach.
    pub bounds: Aabb,
    /// Is the distance from the light below which the near plane is not moved for its sake.
    pub nearest: f64,
    /// Is the largest distance of its corners from the light along an axis.
    pub farthest_corner: f64,
}

impl Reached {
    /// Fills the lists from `input`, for a light at `light` in render space.
    pub fn find(&mut self, input: &LocalInput<'_>, light: DVec3, reach: f64) {
        // The distance is rounded outward, since boxes are rounded to f32.
        let outward = reach * (1.0 + 1e-6) + light.abs().max_element() * 1e-6;
        let around = Aabb::new((light - outward).as_vec3(), (light + outward).as_vec3());
        let near = |bounds: &Aabb| {
            let part = intersection(bounds, &around);
            (!part.is_empty() && distance_squared(&part, light) <= outward * outward)
                .then_some(part)
        };
        self.casters.clear();
        self.receivers.clear();
        let receivers = &mut self.receivers;
        let touches = |around: &Aabb| near(around).is_some();
        input.receivers.walk(
            receivers,
            |_, around| touches(around),
            |receivers, _, bounds| receivers.extend(near(bounds)),
        );
        let visible = self.visible_bounds(input);
        let reached_caster = |(index, bounds): (u32, &Aabb)| {
            let part = near(bounds).filter(|_| can_shadow(bounds, &visible, light))?;
            Some(ReachedCaster {
                index,
                bounds: part,
                nearest: nearest_for(bounds, light, reach, input.near_plane_texels),
                farthest_corner: farthest_corner(bounds, light).max_element(),
            })
        };
        input.casters.walk(
            &mut self.casters,
            |_, around| touches(around),
            |casters, index, bounds| casters.extend(reached_caster((index, bounds))),
        );
    }

    /// Returns the least distance from the light at which a near plane of these casters can be.
    pub fn nearest(&self) -> f64 {
        let each = self.casters.iter().map(|caster| caster.nearest);
        each.fold(f64::INFINITY, f64::min)
    }

    /// Returns the bounds of the receivers that count.
    fn visible_bounds(&self, input: &LocalInput<'_>) -> (DVec3, DVec3) {
        let (mut min, mut max) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
        let everywhere = input.seen.iter().flat_map(|seen| {
            let receivers = self.receivers.iter();
            receivers.map(move |bounds| (seen, bounds))
        });
        for (seen, bounds) in everywhere {
            let (low, high) = (bounds.min.as_dvec3(), bounds.max.as_dvec3());
            if min.cmple(low).all() && max.cmpge(high).all() {
                continue;
            }
            if seen.relation(bounds) == Relation::Inside {
                min = min.min(low);
                max = max.max(high);
                continue;
            }
            seen.visit_vertices(bounds, |vertex| {
                min = min.min(vertex);
                max = max.max(vertex);
            });
        }
        (min, max)
    }
}

/// Returns the distance from the light of the farthest point of a receiver that is seen and within
/// `cone`, or the light's range where one is farther than that; 0 where nothing is seen.
pub(crate) fn farthest_seen(input: &LocalInput<'_>, light: DVec3, cone: &HalfSpaces) -> f64 {
    let mut farthest: f64 = 0.0;
    for seen in input.seen {
        let mut region = *seen;
        cone.as_slice().iter().for_each(|plane| region.push(*plane));
        input.receivers.walk(
            &mut farthest,
            |farthest, around| {
                *farthest < input.range
                    && farthest_corner(around, light).length() > *farthest
                    && !region.surely_misses(around)
            },
            |farthest, _, bounds| {
                let corner = farthest_corner(bounds, light).length();
                if corner <= *farthest || *farthest >= input.range {
                    return;
                }
                if region.relation(bounds) == Relation::Inside {
                    *farthest = corner;
                } else {
                    region.visit_vertices(bounds, |vertex| {
                        *farthest = farthest.max(vertex.distance(light));
                    });
                }
            },
        );
    }
    farthest.min(input.range)
}

/// Returns the distances of the farthest corner of a box from a point along each axis.
fn farthest_corner(bounds: &Aabb, point: DVec3) -> DVec3 {
    let (min, max) = (bounds.min.as_dvec3(), bounds.max.as_dvec3());
    (point - min).abs().max((point - max).abs())
}

fn intersection(a: &Aabb, b: &Aabb) -> Aabb {
    Aabb::new(a.min.max(b.min), a.max.min(b.max))
}

/// Returns the squared distance of a point from a box; 0 inside.
fn distance_squared(bounds: &Aabb, point: DVec3) -> f64 {
    let nearest = point.clamp(bounds.min.as_dvec3(), bounds.max.as_dvec3());
    nearest.distance_squared(point)
}

/// Returns whether a shadow of `caster` can fall on anything in `visible`. Shadows lead away from
/// the light: on an axis on which the light is to one side of the caster, some receiver must be
/// beyond the caster's near side. The flat wall of a room fails this.
fn can_shadow(caster: &Aabb, visible: &(DVec3, DVec3), light: DVec3) -> bool {
    let (low, high) = (caster.min.as_dvec3(), caster.max.as_dvec3());
    !caster.is_empty()
        && (0..3).all(|axis| {
            if light[axis] < low[axis] {
                visible.1[axis] > low[axis]
            } else if light[axis] > high[axis] {
                visible.0[axis] < high[axis]
            } else {
                true
            }
        })
}
