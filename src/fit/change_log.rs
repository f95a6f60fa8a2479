//! Remembers which boxes have changed, so that a light that none of them reaches keeps its fit.

use crate::Aabb;

/// Is the number of changes that are remembered. A light tests each of them in a few nanoseconds,
/// so that even all of them cost less than a fit; in a scene in which more boxes change in a frame,
/// most lights are reached by one.
const CAPACITY: usize = 4096;

/// Is a box that has changed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct ChangedBox {
    /// Is the index of the box.
    pub index: u32,
    /// Holds the box as it was or as it became, or both of them where they overlap.
    pub bounds: Aabb,
}

/// Holds the latest changes of boxes that are known by indices.
#[derive(Debug, Default)]
pub(crate) struct ChangeLog {
    /// Holds the change with the number `n` at the place `n % CAPACITY`.
    ring: Vec<ChangedBox>,
    /// Is the number of the next change.
    next: u64,
}

/// Is what has changed since some number.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ChangedBoxes<'a> {
    /// Is filled before the second.
    halves: [&'a [ChangedBox]; 2],
}

impl ChangeLog {
    /// Returns the number of the next change. Where two numbers are equal, nothing changed between
    /// them.
    pub(crate) fn next(&self) -> u64 {
        self.next
    }

    /// Adds the change of a box, or of something else about what is in it where both boxes are
    /// equal. What was empty and remains so is no change.
    pub(crate) fn add(&mut self, index: u32, before: &Aabb, after: &Aabb) {
        match (before.is_empty(), after.is_empty()) {
            (true, true) => {}
            (true, false) => self.push(index, *after),
            (false, true) => self.push(index, *before),
            (false, false) => {
                let overlap =
                    before.min.cmple(after.max).all() && before.max.cmpge(after.min).all();
                if overlap {
                    let bounds = Aabb::new(before.min.min(after.min), before.max.max(after.max));
                    self.push(index, bounds);
                } else {
                    self.push(index, *before);
                    self.push(index, *after);
                }
            }
        }
    }

    /// States that any box may have changed.
    pub(crate) fn add_unknown(&mut self) {
        // A multiple of the capacity leaves the places of numbers as they are.
        self.next += 2 * CAPACITY as u64;
    }

    fn push(&mut self, index: u32, bounds: Aabb) {
        let changed = ChangedBox { index, bounds };
        let place = (self.next % CAPACITY as u64) as usize;
        match self.ring.get_mut(place) {
            Some(oldest) => *oldest = changed,
            None => self.ring.push(changed),
        }
        self.next += 1;
    }

    /// Returns the changes from the number `first` on, or `None` where they are no longer known.
    pub(crate) fn since(&self, first: u64) -> Option<ChangedBoxes<'_>> {
        let count = self.next.checked_sub(first)?;
        if count > CAPACITY as u64 {
            return None;
        }
        let start = (first % CAPACITY as u64) as usize;
        let end = start + count as usize;
        let halves = [
            &self.ring[start..end.min(self.ring.len())],
            &self.ring[..end.saturating_sub(CAPACITY)],
        ];
        Some(ChangedBoxes { halves })
    }
}

impl<'a> ChangedBoxes<'a> {
    /// Returns whether nothing has changed.
    pub(crate) fn is_empty(&self) -> bool {
        self.halves[0].is_empty()
    }

    pub(crate) fn iter(&self) -> impl Iterator<Item = &'a ChangedBox> + use<'a> {
        let [older, newer] = self.halves;
        older.iter().chain(newer)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::Vec3;

    fn unit_box(at: f32) -> Aabb {
        Aabb::new(Vec3::splat(at), Vec3::splat(at + 1.0))
    }

    /// Checks against a list of all changes that the log returns exactly those since a number, or
    /// none where there are more than it remembers, however often its ring has begun anew.
    #[test]
    fn a_log_returns_what_changed_since_a_number_or_that_it_does_not_know() {
        let mut log = ChangeLog::default();
        let mut all: Vec<(u64, u32)> = Vec::new();
        for index in 0..3 * CAPACITY as u32 {
            all.push((log.next(), index));
            log.add(index, &unit_box(0.0), &unit_box(0.5));
            if index == 100 || index == CAPACITY as u32 + 7 {
                log.add_unknown();
                all.clear();
            }
            if !index.is_multiple_of(61) {
                continue;
            }
            for back in [0, 1, 17, 2000, CAPACITY, CAPACITY + 1] {
                let Some(from) = all.len().checked_sub(back) else {
                    continue;
                };
                let first = all.get(from).map_or(log.next(), |(number, _)| *number);
                let found = log.since(first);
                assert_eq!(found.is_some(), back <= CAPACITY, "{back} at {index}");
                let found = found.map(|found| found.iter().map(|c| c.index).collect::<Vec<_>>());
                let wanted: Vec<u32> = all[from..].iter().map(|(_, index)| *index).collect();
                assert!(
                    found.is_none_or(|found| found == wanted),
                    "{back} at {index}"
                );
            }
        }
        assert!(log.since(0).is_none());
        assert!(log.since(log.next() + 1).is_none());
    }

    /// Checks that a change contains the box before it and the box after it, as one where they
    /// overlap, and that nothing is said of boxes that are empty.
    #[test]
    fn a_change_is_where_the_box_was_and_where_it_is() {
        let changes = |before: Aabb, after: Aabb| {
            let mut log = ChangeLog::default();
            log.add(3, &before, &after);
            let found = log.since(0).expect("few changes").iter().copied();
            found.map(|changed| changed.bounds).collect::<Vec<_>>()
        };
        let joined = Aabb::new(Vec3::ZERO, Vec3::splat(1.5));
        assert_eq!(changes(unit_box(0.0), unit_box(0.5)), [joined]);
        let apart = [unit_box(0.0), unit_box(5.0)];
        assert_eq!(changes(apart[0], apart[1]), apart);
        assert_eq!(changes(Aabb::EMPTY, unit_box(2.0)), [unit_box(2.0)]);
        assert_eq!(changes(unit_box(2.0), Aabb::EMPTY), [unit_box(2.0)]);
        assert!(changes(Aabb::EMPTY, Aabb::EMPTY).is_empty());
    }
}
