//! Finds what a local light reaches, once a frame; the result is then divided among its views.

use glam::DVec3;

use crate::Aabb;
use crate::fit::box_arrays::BoxArrays;
use crate::fit::change_log::ChangedBox;
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
    receivers: Vec<Aabb>,
    /// Holds the boxes of the two lists, relative to the light.
    caster_boxes: BoxArrays,
    receiver_boxes: BoxArrays,
    /// Holds the numbers, in the list, of casters that may be in a view, and of receivers.
    candidates: Vec<u32>,
    receivers_found: Vec<u32>,
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

/// Is the sphere around a light within which casters and receivers matter to it.
struct Reach {
    light: DVec3,
    radius: f64,
    /// Is the box around it.
    around: Aabb,
}

impl Reach {
    fn new(light: DVec3, reach: f64) -> Self {
        // The distance is rounded outward, since boxes are rounded to f32.
        let radius = reach * (1.0 + 1e-6) + light.abs().max_element() * 1e-6;
        Self {
            light,
            radius,
            around: Aabb::new((light - radius).as_vec3(), (light + radius).as_vec3()),
        }
    }

    /// Returns the part of a box within the box around the sphere, or `None` where the sphere does
    /// not meet it. A box has a part wherever any box in it has one, whatever the rounding.
    fn part(&self, bounds: &Aabb) -> Option<Aabb> {
        let part = intersection(bounds, &self.around);
        let meets =
            !part.is_empty() && distance_squared(&part, self.light) <= self.radius * self.radius;
        meets.then_some(part)
    }
}

impl Reached {
    /// Fills the lists from `input`, for a light at `light` in render space.
    pub(crate) fn find(&mut self, input: &LocalInput<'_>, light: DVec3, reach: f64) {
        let within = Reach::new(light, reach);
        let near = |bounds: &Aabb| within.part(bounds);
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
        self.caster_boxes.clear();
        for caster in &self.casters {
            self.caster_boxes.push(&caster.bounds, light);
        }
        self.receiver_boxes.clear();
        for bounds in &self.receivers {
            self.receiver_boxes.push(bounds, light);
        }
    }

    /// Finds the casters that may be in a region.
    pub(crate) fn find_candidates(&mut self, region: &HalfSpaces, light: DVec3) {
        let found = &mut self.candidates;
        self.caster_boxes.find_in(region, light, found);
    }

    /// Returns the casters that were found last.
    pub(crate) fn candidates(&self) -> impl Iterator<Item = &ReachedCaster> + Clone {
        let found = self.candidates.iter();
        found.map(|&number| &self.casters[number as usize])
    }

    /// Returns the receivers that may be in a region.
    pub(crate) fn receivers_in(
        &mut self,
        region: &HalfSpaces,
        light: DVec3,
    ) -> impl Iterator<Item = &Aabb> + Clone {
        let found = &mut self.receivers_found;
        self.receiver_boxes.find_in(region, light, found);
        let receivers = &self.receivers;
        found.iter().map(|&number| &receivers[number as usize])
    }

    /// Returns the least distance from the light at which a near plane of these casters can be.
    pub(crate) fn nearest(&self) -> f64 {
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

/// Is the farthest point, from a light, of what is seen.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct FarthestSeen {
    /// Is its distance, and at most the light's range; 0 where nothing is seen.
    pub distance: f64,
    /// Is the index of the caster that it is a point of, if it is one's.
    pub caster: Option<u32>,
}

/// Returns the farthest point of a receiver that is seen and within `cone`, or any that is as far
/// as the light's range.
pub(crate) fn farthest_seen(
    input: &LocalInput<'_>,
    light: DVec3,
    cone: &HalfSpaces,
) -> FarthestSeen {
    let mut farthest = FarthestSeen::default();
    for seen in input.seen {
        let mut region = *seen;
        cone.as_slice().iter().for_each(|plane| region.push(*plane));
        input.receivers.walk(
            &mut farthest,
            |farthest, around| {
                farthest.distance < input.range
                    && farthest_corner(around, light).length() > farthest.distance
                    && !region.surely_misses(around)
            },
            |farthest, caster, bounds| {
                let corner = farthest_corner(bounds, light).length();
                if corner <= farthest.distance || farthest.distance >= input.range {
                    return;
                }
                let mut distance = farthest.distance;
                if region.relation(bounds) == Relation::Inside {
                    distance = corner;
                } else {
                    region.visit_vertices(bounds, |vertex| {
                        distance = distance.max(vertex.distance(light));
                    });
                }
                if distance > farthest.distance {
                    *farthest = FarthestSeen { distance, caster };
                }
            },
        );
    }
    farthest.distance = farthest.distance.min(input.range);
    farthest
}

/// Returns whether a receiver within `bounds` may be seen, within `cone`, farther from the light
/// than `distance`.
fn may_be_seen_beyond(
    distance: f64,
    bounds: &Aabb,
    input: &LocalInput<'_>,
    light: DVec3,
    cone: &HalfSpaces,
) -> bool {
    let region = |seen: &HalfSpaces| {
        let mut region = *seen;
        cone.as_slice().iter().for_each(|plane| region.push(*plane));
        region
    };
    distance < input.range
        && farthest_corner(bounds, light).length() > distance
        && input
            .seen
            .iter()
            .any(|seen| !region(seen).surely_misses(bounds))
}

/// Returns whether a fit to `farthest`, with the reach that followed from it, may become another
/// where casters and receivers change within `changed`.
pub(crate) fn may_change(
    changed: &ChangedBox,
    (farthest, reach): (&FarthestSeen, f64),
    input: &LocalInput<'_>,
    light: DVec3,
    cone: &HalfSpaces,
) -> bool {
    Reach::new(light, reach).part(&changed.bounds).is_some()
        || farthest.caster == Some(changed.index)
        || may_be_seen_beyond(farthest.distance, &changed.bounds, input, light, cone)
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
