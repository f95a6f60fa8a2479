//! Finds the largest casters of a frame.

use std::cmp::Ordering;

use crate::Aabb;
use crate::fit::axes::LightBox;
use crate::fit::directional_casters::DirectionalCasters;
use crate::fit::spacing::Spacing;

/// Is a caster that may be divided.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Large {
    pub caster: u32,
    /// Is the wider side, seen from the light, of the area of visible receivers that it covers.
    pub side: f64,
    pub light: LightBox,
    bounds: Aabb,
}

impl Large {
    /// Compares two casters by size, the larger first, and equally large ones by where they are, so
    /// that the order in which they are found does not matter.
    fn order(&self, other: &Self) -> Ordering {
        let by_place = || order_of_bounds(&self.bounds, &other.bounds);
        other.side.total_cmp(&self.side).then_with(by_place)
    }
}

/// Collects the largest casters.
pub(crate) struct LargestCasters<'a> {
    large: &'a mut Vec<Large>,
    limit: usize,
    /// Is a side below which a caster is none of the largest.
    least_side: f64,
    /// Holds what the others cover.
    rest: LightBox,
}

impl LargestCasters<'_> {
    /// Fills `large` with those casters, at most `limit`, that cover most of `visible` along one
    /// axis, the largest first. Returns what all others cover of it.
    pub(super) fn find(
        candidates: &DirectionalCasters<'_>,
        visible: &LightBox,
        limit: usize,
        large: &mut Vec<Large>,
    ) -> LightBox {
        large.clear();
        let mut largest = LargestCasters {
            large,
            limit,
            least_side: 0.0,
            rest: LightBox::EMPTY,
        };
        candidates.walk(
            Spacing::around(candidates.space.origin, visible),
            &mut largest,
            |largest, around| {
                let covered = around.intersection_xy(visible);
                covered.is_some_and(|covered| largest.changes_with(&covered))
            },
            |largest, caster, bounds, light| {
                if let Some(covered) = light.intersection_xy(visible) {
                    largest.add(Large {
                        caster,
                        side: covered.widest_side(),
                        light: covered,
                        bounds: *bounds,
                    });
                }
            },
        );
        largest.select();
        let rest = largest.rest;
        large.sort_unstable_by(Large::order);
        rest
    }

    fn add(&mut self, large: Large) {
        if large.side < self.least_side {
            self.rest.union(&large.light);
            return;
        }
        self.large.push(large);
        if self.large.len() > 4 * self.limit {
            self.select();
        }
    }

    /// Keeps no more than the limit.
    fn select(&mut self) {
        if self.large.len() > self.limit {
            self.large.select_nth_unstable_by(self.limit, Large::order);
            for large in self.large.drain(self.limit..) {
                self.rest.union(&large.light);
            }
            let sides = self.large.iter().map(|large| large.side);
            self.least_side = sides.fold(f64::INFINITY, f64::min);
        }
    }

    /// Returns whether a caster that covers no more than `covered` may change what is collected.
    fn changes_with(&self, covered: &LightBox) -> bool {
        covered.widest_side() >= self.least_side || !self.rest.holds_xy(covered)
    }
}

/// Orders boxes by their coordinates.
pub(crate) fn order_of_bounds(a: &Aabb, b: &Aabb) -> Ordering {
    let coordinates = |bounds: &Aabb| [bounds.min.to_array(), bounds.max.to_array()];
    let pairs = coordinates(a)
        .into_iter()
        .flatten()
        .zip(coordinates(b).into_iter().flatten());
    pairs.fold(Ordering::Equal, |order, (a, b)| {
        order.then_with(|| a.total_cmp(&b))
    })
}
