//! Packs squares into a layer, each a half, a quarter, an eighth and so on of its side, and moves
//! as few of them as it can.
//!
//! Such squares are the nodes of a quadtree. Taken from the largest to the smallest, they never
//! leave a gap in which another would not fit: where the squares that are as large as a new one, or
//! larger, leave room for it by their area, they leave a whole node.

use glam::UVec2;

use crate::fit::texel_rect::TexelRect;

/// Is a node of the quadtree over a layer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Square {
    /// Is how often the side of the layer is halved.
    pub level: u32,
    /// Counts squares of this size from the first column and row.
    place: UVec2,
}

impl Square {
    const WHOLE: Self = Self {
        level: 0,
        place: UVec2::ZERO,
    };

    /// Returns the texels of the square in a layer of `map_size` texels a side. Squares that are
    /// apart have no texel in common, whether the side can be halved or not.
    pub(crate) fn texels(&self, map_size: u32) -> TexelRect {
        let start = |place: u32| ((u64::from(place) * u64::from(map_size)) >> self.level) as u32;
        TexelRect {
            min: UVec2::new(start(self.place.x), start(self.place.y)),
            size: UVec2::splat(side_texels(map_size, self.level)),
        }
    }

    /// Returns whether the squares have a part in common; one then holds the other.
    fn meets(&self, other: &Self) -> bool {
        let (large, small) = if self.level <= other.level {
            (self, other)
        } else {
            (other, self)
        };
        small.place >> (small.level - large.level) == large.place
    }

    /// Returns the first square of a finer level within this one.
    pub(crate) fn first_part(&self, level: u32) -> Self {
        Self {
            level,
            place: self.place << (level - self.level),
        }
    }

    fn quarters(&self) -> [Self; 4] {
        [(0, 0), (1, 0), (0, 1), (1, 1)].map(|(x, y)| Self {
            level: self.level + 1,
            place: self.place * 2 + UVec2::new(x, y),
        })
    }
}

/// Returns the number of texels per side of a square.
pub(crate) fn side_texels(map_size: u32, level: u32) -> u32 {
    map_size.checked_shr(level).unwrap_or(0)
}

/// Tells what happens to a square that is in the way of another.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Hold {
    /// Stays where it is.
    Fixed,
    /// Moves elsewhere, which takes a depth pass.
    Movable,
    /// Is given up: nothing is lost but a map that may not be needed again.
    Idle,
}

/// Holds the squares of a layer by the index of the view that each belongs to.
#[derive(Clone, Debug, Default)]
pub(crate) struct Packing {
    squares: Vec<Option<Square>>,
}

/// Is a place for a square, with what stands in the way.
#[derive(Clone, Copy, Debug)]
struct Candidate {
    square: Square,
    /// Counts the squares to be moved.
    moved: u32,
    /// Counts those to be given up.
    idle: u32,
    /// Is the level of the largest square around it that is as free.
    around: u32,
}

impl Packing {
    /// Makes an empty layer for so many views.
    pub(crate) fn new(views: usize) -> Self {
        Self {
            squares: vec![None; views],
        }
    }

    /// Returns the square of a view.
    pub(crate) fn square(&self, view: usize) -> Option<Square> {
        self.squares[view]
    }

    /// Sets the square of a view, which must have no part in common with those of other views.
    pub(crate) fn set(&mut self, view: usize, square: Option<Square>) {
        self.squares[view] = square;
    }

    /// Finds a place for a square of `level` for a view that has none, and makes room for it with
    /// at most `most_moved` moves of smaller squares. `hold` tells what may happen to the square of
    /// a view; those of `level` or larger never move. Returns the views that have lost their
    /// squares, or `None`, with nothing changed, where there is no such place.
    pub(crate) fn place(
        &mut self,
        view: usize,
        level: u32,
        most_moved: u32,
        hold: impl Fn(usize) -> Hold,
    ) -> Option<Displaced> {
        let occupants = self.squares.iter().enumerate();
        let occupants: Vec<(usize, Square, Hold)> = occupants
            .filter_map(|(view, square)| Some((view, (*square)?, hold(view))))
            .collect();
        let mut best = None;
        search(Square::WHOLE, &occupants, level, most_moved, &mut best);
        let square = best?.square;
        let mut displaced = Displaced::default();
        for (view, _, hold) in occupants.iter().filter(|(_, own, _)| own.meets(&square)) {
            let list = match hold {
                Hold::Movable => &mut displaced.moved,
                Hold::Fixed | Hold::Idle => &mut displaced.idle,
            };
            list.push((*view, self.squares[*view].map_or(level, |own| own.level)));
            self.squares[*view] = None;
        }
        self.squares[view] = Some(square);
        Some(displaced)
    }
}

/// Lists views that have lost their squares, with the levels of these.
#[derive(Debug, Default)]
pub(crate) struct Displaced {
    pub moved: Vec<(usize, u32)>,
    pub idle: Vec<(usize, u32)>,
}

/// Looks within `node` for the best place for a square of `level`. `occupants` are those that have
/// a part in common with the node.
fn search(
    node: Square,
    occupants: &[(usize, Square, Hold)],
    level: u32,
    most_moved: u32,
    best: &mut Option<Candidate>,
) {
    let stays = |(_, square, hold): &(usize, Square, Hold)| match hold {
        Hold::Fixed => square.level <= node.level,
        Hold::Movable => square.level <= node.level.min(level),
        Hold::Idle => false,
    };
    if occupants.iter().any(stays) {
        return;
    }
    let count = |wanted| {
        let held = occupants.iter().filter(|(_, _, hold)| *hold == wanted);
        held.count() as u32
    };
    if node.level == level || occupants.is_empty() {
        let (moved, idle) = (count(Hold::Movable), count(Hold::Idle));
        if count(Hold::Fixed) > 0 || moved > most_moved {
            return;
        }
        let candidate = Candidate {
            square: node.first_part(level),
            moved,
            idle,
            around: node.level,
        };
        // The smallest gap is filled first, so that large ones remain.
        let rank = |c: &Candidate| (c.moved, c.idle, std::cmp::Reverse(c.around));
        if best
            .as_ref()
            .is_none_or(|best| rank(&candidate) < rank(best))
        {
            *best = Some(candidate);
        }
        return;
    }
    for part in node.quarters() {
        let within = occupants.iter().filter(|(_, own, _)| own.meets(&part));
        let within: Vec<_> = within.copied().collect();
        search(part, &within, level, most_moved, best);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A sequence that is the same in every run, below `count`.
    fn next(state: &mut u64, count: usize) -> usize {
        *state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1);
        (*state >> 33) as usize % count
    }

    fn area(level: u32) -> u64 {
        1 << (20 - 2 * level)
    }

    /// Whatever comes and goes, squares are apart; and as long as those that are wanted together
    /// are no larger than the layer, each finds a place where all others may move.
    #[test]
    fn what_fits_by_area_fits() {
        let mut state = 5;
        let mut packing = Packing::new(40);
        for _ in 0..20_000 {
            let view = next(&mut state, 40);
            packing.set(view, None);
            let level = 1 + next(&mut state, 6) as u32;
            let squares = (0..40).filter_map(|view| packing.square(view));
            let taken: u64 = squares.map(|square| area(square.level)).sum();
            if taken + area(level) > area(0) {
                continue;
            }
            let mut waiting = vec![(level, view)];
            while let Some(&(level, view)) = waiting.iter().min() {
                waiting.retain(|other| other.1 != view);
                let displaced = packing.place(view, level, u32::MAX, |_| Hold::Movable);
                let displaced = displaced.expect("a place");
                waiting.extend(displaced.moved.iter().map(|(view, level)| (*level, *view)));
            }
            for side in [64, 100] {
                let squares = (0..40).filter_map(|view| packing.square(view));
                let rects: Vec<TexelRect> = squares.map(|square| square.texels(side)).collect();
                for (index, a) in rects.iter().enumerate() {
                    assert!((a.min + a.size).max_element() <= side);
                    for b in &rects[..index] {
                        let meets = a.min.cmplt(b.min + b.size) & b.min.cmplt(a.min + a.size);
                        assert!(!meets.all(), "{a:?} {b:?}");
                    }
                }
            }
        }
    }

    /// What is fixed never moves, and is never taken.
    #[test]
    fn what_is_fixed_stays() {
        let mut packing = Packing::new(3);
        let nothing = packing.place(0, 1, 0, |_| Hold::Fixed);
        assert!(nothing.is_some_and(|displaced| displaced.moved.is_empty()));
        let first = packing.square(0);
        assert!(packing.place(1, 0, 9, |_| Hold::Fixed).is_none());
        assert_eq!((packing.square(0), packing.square(1)), (first, None));
        let taken = packing.place(1, 0, 0, |_| Hold::Idle).expect("a place");
        assert_eq!(taken.idle, [(0, 1)]);
    }
}
