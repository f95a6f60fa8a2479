//! Finds the parts of large casters behind which visible receivers lie.
//!
//! The bounds of a ground may reach to the horizon, while all that it can shadow is a foot that is
//! sunk into it. Of a caster that is much larger than the others, therefore only those parts count:
//! for each receiver, the intersection of the caster's bounds with the receiver's bounds extruded
//! toward the light.

use glam::DVec3;

use crate::Aabb;
use crate::fit::axes::{LightBox, LightSpace};
use crate::fit::boxes::Boxes;
use crate::fit::caster_shape::CasterShape;
use crate::fit::directional_casters::DirectionalCasters;
use crate::fit::large_casters::{Large, LargestCasters, order_of_bounds};
use crate::fit::view_rounding::position_error_world;
use crate::fit::visible::SeenReceiver;

/// Is the largest number of casters that are divided into parts, so that the cost stays
/// proportional to the number of receivers.
const MAX_DIVIDED: usize = 16;

/// Is the largest number of pairs of a divided caster and a receiver in a frame.
const MAX_PAIRS: usize = 1 << 16;

/// Is the least side of a large caster, as a fraction of the side of what all casters cover
/// together. A smaller one, counted as a whole, makes the map at most a quarter wider, which is
/// little more than one size step.
const LARGE_SHARE: f64 = 0.25;

/// Is the union of the parts of one caster that rise about equally high above what they shadow.
#[derive(Clone, Copy, Debug)]
pub(crate) struct CasterPart {
    pub caster: u32,
    /// Is the greatest distance in world units, perpendicular to the receiver where its direction
    /// is known, between a point of the part and a receiver behind it.
    pub height: f64,
    pub bounds: Aabb,
    pub light: LightBox,
}

/// Holds what is known of the casters of a frame.
struct Casters<'a> {
    space: &'a LightSpace,
    boxes: Boxes<'a>,
}

/// Holds lists that are reused from frame to frame.
#[derive(Debug, Default)]
pub(crate) struct PartScratch {
    large: Vec<Large>,
    /// Holds the parts of all divided casters, the highest above their receivers first.
    pub parts: Vec<CasterPart>,
    /// Holds the divided casters.
    pub divided: Vec<u32>,
}

impl PartScratch {
    /// Divides no caster.
    pub(super) fn clear(&mut self) {
        self.parts.clear();
        self.divided.clear();
    }

    /// Divides those casters of `candidates` that are large beside all others. `visible` is a
    /// light-space box that holds all receivers of `seen`.
    pub(super) fn find(
        &mut self,
        candidates: &DirectionalCasters<'_>,
        visible: &LightBox,
        seen: &[SeenReceiver],
    ) {
        self.clear();
        let casters = &Casters {
            space: candidates.space,
            boxes: candidates.boxes,
        };
        let limit = MAX_DIVIDED.min(MAX_PAIRS / seen.len().max(1)).max(1);
        let others = LargestCasters::find(candidates, visible, limit, &mut self.large);
        // Starting from the largest, each caster is divided if it is large in relation to the area
        // that the parts of the casters before it and the whole casters after it cover.
        let limit = self.large.len();
        let mut rest = [LightBox::EMPTY; MAX_DIVIDED + 1];
        rest[limit] = others;
        for index in (0..limit).rev() {
            rest[index] = rest[index + 1];
            rest[index].union(&self.large[index].light);
        }
        let mut parts_box = LightBox::EMPTY;
        for (large, remaining) in self.large.iter().zip(&rest[..limit]) {
            let mut all = *remaining;
            all.union(&parts_box);
            if large.side < LARGE_SHARE * all.widest_side() {
                break;
            }
            let first = self.parts.len();
            divide(casters, large.caster, seen, &mut self.parts);
            self.divided.push(large.caster);
            for part in &self.parts[first..] {
                if let Some(covered) = part.light.intersection_xy(visible) {
                    parts_box.union(&covered);
                }
            }
        }
        self.parts.sort_by(|a, b| {
            let by_place = || order_of_bounds(&a.bounds, &b.bounds);
            b.height.total_cmp(&a.height).then_with(by_place)
        });
        self.divided.sort_unstable();
    }
}

/// Adds the parts of a caster behind which receivers of `seen` lie, one part per octave of height.
fn divide(casters: &Casters<'_>, caster: u32, seen: &[SeenReceiver], parts: &mut Vec<CasterPart>) {
    let bounds = casters.boxes.at(caster);
    let shadows_itself = casters.boxes.shape(caster).shadows_itself();
    let first = parts.len();
    // The depths of a caster are rounded at its corners, and in maps that contain it the bias
    // allows for twice that rounding. A caster that rises no more than four times as high above its
    // receivers would cost more contact of all other shadows than its own shadow is worth.
    let farthest = bounds.min.abs().max(bounds.max.abs()).as_dvec3().length();
    let least_height = 8.0 * position_error_world(farthest);
    let toward_light = casters.space.axes.toward_light();
    let mut add = |pair: Pair| {
        if pair.height <= least_height {
            return;
        }
        let octave = pair.height.log2().floor();
        let same = parts[first..]
            .iter_mut()
            .find(|part| part.height.log2().floor() == octave);
        let light = casters.space.bounds(&pair.bounds);
        match same {
            Some(part) => {
                part.height = part.height.max(pair.height);
                part.bounds = part.bounds.union(pair.bounds);
                part.light.union(&light);
            }
            None => parts.push(CasterPart {
                caster,
                height: pair.height,
                bounds: pair.bounds,
                light,
            }),
        }
    };
    for receiver in seen {
        if receiver.caster == Some(caster) && !shadows_itself {
            continue;
        }
        let is_cuboid = receiver
            .caster
            .is_some_and(|of| casters.boxes.shape(of) == CasterShape::Cuboid);
        if is_cuboid {
            for axis in 0..3 {
                if let Some(side) = receiver.lit_side(axis, toward_light) {
                    pair(bounds, side, toward_light)
                        .into_iter()
                        .for_each(&mut add);
                }
            }
        } else {
            let part = (receiver.min, receiver.max);
            pair(bounds, part, toward_light)
                .into_iter()
                .for_each(&mut add);
        }
    }
}

/// Is the part of a caster that lies toward the light from a receiver.
struct Pair {
    bounds: Aabb,
    /// Is the greatest distance between the two, as that of [`CasterPart`].
    height: f64,
}

/// Returns the part of `caster` that is met by the rays toward the light from a box of receivers,
/// or `None` where none is met. A ray must have some length, because a surface does not shadow
/// points in itself.
///
/// A point of the box at `r` meets the caster at `r + s l` for some `s` from `near` to `far`, whose
/// limits follow from the intervals of both boxes on each axis.
fn pair(caster: &Aabb, (min, max): (DVec3, DVec3), toward_light: DVec3) -> Option<Pair> {
    let (low, high) = (caster.min.as_dvec3(), caster.max.as_dvec3());
    let (mut near, mut far) = (0.0_f64, f64::INFINITY);
    for axis in 0..3 {
        let toward = toward_light[axis];
        if toward == 0.0 {
            if high[axis] < min[axis] || low[axis] > max[axis] {
                return None;
            }
            continue;
        }
        let ends = [
            (low[axis] - max[axis]) / toward,
            (high[axis] - min[axis]) / toward,
            (low[axis] - min[axis]) / toward,
            (high[axis] - max[axis]) / toward,
        ];
        near = near.max(ends.into_iter().fold(f64::INFINITY, f64::min));
        far = far.min(ends.into_iter().fold(f64::NEG_INFINITY, f64::max));
    }
    if far <= 0.0 || far < near {
        return None;
    }
    let (from, to) = (toward_light * near, toward_light * far);
    let part_min = low.max(min + from.min(to));
    let part_max = high.min(max + from.max(to)).max(part_min);
    let flat_axes = (0..3).filter(|&axis| min[axis] == max[axis]);
    let across = flat_axes.map(|axis| toward_light[axis].abs());
    Some(Pair {
        bounds: Aabb::around(part_min, part_max),
        height: far * across.reduce(f64::max).unwrap_or(1.0),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fit::directional_casters::DirectionalCaster;
    use crate::fit::visible::SeenBounds;
    use crate::fit::{CasterBox, LightAxes, Role};
    use glam::Vec3;

    const DOWNWARD: DVec3 = DVec3::new(0.0, -1.0, 0.0);

    fn seen(bounds: Aabb, caster: Option<u32>) -> SeenReceiver {
        SeenReceiver::whole(&bounds, caster)
    }

    /// Returns the parts of the casters for a light that shines along `direction`.
    fn parts(
        direction: DVec3,
        bounds: &[Aabb],
        shapes: &[CasterShape],
        seen: &[SeenReceiver],
    ) -> Vec<CasterPart> {
        let space = LightSpace {
            axes: LightAxes::new(direction, DVec3::Y),
            origin: DVec3::ZERO,
        };
        let listed = (0..).zip(bounds).map(|(index, bounds)| DirectionalCaster {
            index,
            light: space.bounds(bounds),
        });
        let listed: Vec<_> = listed.collect();
        let mut visible = LightBox::EMPTY;
        listed
            .iter()
            .for_each(|caster| visible.union(&caster.light));
        let members = bounds.iter().zip(shapes);
        let members = members.map(|(bounds, shape)| CasterBox {
            bounds: *bounds,
            casts: true,
            receives: true,
            shape: *shape,
        });
        let members: Vec<CasterBox> = members.collect();
        let candidates = DirectionalCasters {
            space: &space,
            boxes: Boxes {
                members: &members,
                role: Role::Casts,
                tree: None,
            },
            visible: &SeenBounds::of_boxes([&Aabb::new(Vec3::NEG_INFINITY, Vec3::INFINITY)]),
            divided: &[],
            listed: &listed,
        };
        let mut scratch = PartScratch::default();
        scratch.find(&candidates, &visible, seen);
        assert!(scratch.divided.contains(&0), "{:?}", scratch.divided);
        scratch.parts
    }

    /// Returns the parts of the first caster.
    fn of_first(parts: Vec<CasterPart>) -> Vec<CasterPart> {
        parts.into_iter().filter(|part| part.caster == 0).collect()
    }

    fn ground(half: f32, low: f32) -> Aabb {
        Aabb::new(Vec3::new(-half, low, -half), Vec3::new(half, 0.0, half))
    }

    fn robot(low: f32) -> Aabb {
        Aabb::new(Vec3::new(-0.2, low, -0.2), Vec3::new(0.2, 0.8, 0.2))
    }

    /// Checks that only the part of a flat ground that is above a sunk foot counts, whatever the
    /// ground's size.
    #[test]
    fn a_flat_ground_counts_where_a_foot_is_below_it() {
        for half in [5.0_f32, 500.0, 5000.0] {
            let bounds = [ground(half, 0.0), robot(-0.01)];
            let receivers = [seen(bounds[0], Some(0)), seen(bounds[1], Some(1))];
            let shapes = [CasterShape::Any; 2];
            let direction = DVec3::new(0.6, -0.7, 0.4);
            let parts = of_first(parts(direction, &bounds, &shapes, &receivers));
            let [part] = parts[..] else {
                panic!("{parts:?}");
            };
            // The foot is one centimetre below: toward the light that is at most 1 cm / 0.7 = 1.5
            // cm.
            assert!((part.bounds.max.x - 0.2).abs() < 0.015 && part.bounds.min.x >= -0.22);
            assert!((part.height - 0.01 / (0.7 / 1.01_f64.sqrt())).abs() < 1e-6);
        }
    }

    /// Checks that a thick slab shadows itself unless its shape says otherwise.
    #[test]
    fn a_slab_shadows_itself_unless_its_shape_forbids_it() {
        let bounds = [ground(100.0, -1.0), robot(0.0)];
        let receivers = [seen(bounds[0], Some(0)), seen(bounds[1], Some(1))];
        let any = parts(DOWNWARD, &bounds, &[CasterShape::Any; 2], &receivers);
        assert!(any.iter().any(|part| part.bounds.max.x == 100.0));
        for shape in [CasterShape::Convex, CasterShape::Cuboid] {
            let shapes = [shape, CasterShape::Any];
            let parts = of_first(parts(DOWNWARD, &bounds, &shapes, &receivers));
            assert!(parts.is_empty(), "{shape:?}: {parts:?}");
        }
    }

    /// Checks that the height of a carpet two millimetres above a thick ground is measured from the
    /// ground's upper side if the ground is a cuboid, and otherwise from its lower side.
    #[test]
    fn a_carpet_is_as_high_as_it_lies_above_a_cuboid() {
        let carpet = Aabb::new(Vec3::new(-4.0, 0.002, -4.0), Vec3::new(4.0, 0.002, 4.0));
        let bounds = [ground(100.0, -1.0), carpet];
        let receivers = [seen(bounds[0], Some(0)), seen(carpet, Some(1))];
        for (shape, height) in [(CasterShape::Cuboid, 0.002), (CasterShape::Convex, 1.002)] {
            let parts = parts(DOWNWARD, &bounds, &[shape, CasterShape::Any], &receivers);
            let highest = parts.iter().map(|part| part.height).fold(0.0, f64::max);
            assert!((highest - height).abs() < 1e-6, "{shape:?}: {parts:?}");
        }
    }

    /// Checks against random rays that every point of a caster that is met from a receiver is
    /// within the caster's parts.
    #[test]
    fn parts_hold_all_that_rays_meet() {
        let mut state = 7_u32;
        let mut random = || {
            state = state.wrapping_mul(747_796_405).wrapping_add(2_891_336_453);
            f64::from(state) / f64::from(u32::MAX)
        };
        let mut met = 0;
        for _ in 0..40_000 {
            let mut vector =
                |low: f64, high: f64| DVec3::new(random(), random(), random()) * (high - low) + low;
            let direction = vector(-1.0, 1.0);
            let (caster_low, receiver_low) = (vector(-4.0, 4.0), vector(-4.0, 4.0));
            let caster = Aabb::around(caster_low, caster_low + vector(0.0, 3.0));
            let receiver = Aabb::around(receiver_low, receiver_low + vector(0.0, 3.0));
            let start = receiver_low + vector(0.0, 1.0) * (receiver.max.as_dvec3() - receiver_low);
            let toward = -direction.normalize();
            let along = vector(0.0, 6.0).x;
            let end = start + toward * along;
            let inside =
                end.cmpge(caster.min.as_dvec3()).all() && end.cmple(caster.max.as_dvec3()).all();
            if !inside {
                continue;
            }
            met += 1;
            let corners = (receiver.min.as_dvec3(), receiver.max.as_dvec3());
            let pair = pair(&caster, corners, toward).expect("a ray met it");
            let (low, high) = (pair.bounds.min.as_dvec3(), pair.bounds.max.as_dvec3());
            assert!(end.cmpge(low - 1e-5).all() && end.cmple(high + 1e-5).all());
            assert!(along <= pair.height * (1.0 + 1e-9) + 1e-9);
        }
        assert!(met > 50, "{met}");
    }
}
