//! Holds boxes in a tree that finds those in a volume, and that follows boxes that move.
//!
//! It is a binary tree of bounding boxes (Goldsmith and Salmon 1987) with the insertion and the
//! rotations of Box2D's dynamic tree (Catto 2019, "Dynamic Bounding Volume Hierarchies"). Crates
//! were judged against what a light needs of a tree, and each lacks something: `rstar` finds a
//! member again only by searching for its old box, so that a move costs two searches and two
//! changes of the tree; `bvh` and `parry3d` bring `nalgebra` or a second version of `glam` into
//! every engine's build, `bvh` moves a member by removing and inserting it, and both walk with
//! volumes that stay the same during a walk. A light's walks narrow while they go: the nearest
//! caster is found by looking into no box that is farther than the nearest so far.
//!
//! Where few boxes leave their fat boxes between two walks, the boxes above each of them grow at
//! once. Where many do, all boxes above are made anew from below by the next walk.
//!
//! ```text
//! nodes.rs        the nodes, how they are walked and refitted
//! restructure.rs  how leaves are added and removed
//! ```

mod nodes;
mod restructure;

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, OnceLock, PoisonError};

use crate::Aabb;
use nodes::{NONE, Node, Nodes, half_area, holds, join};

/// Is the number of frames for which the fat box around a moving box holds it, if its velocity
/// stays the same. So the tree is touched in one frame of eight for each box that moves steadily.
const FRAMES_AHEAD: f32 = 8.0;

/// Is the number of times that a box may leave its fat box and have the boxes above it grow, which
/// is cheap, before its leaf is inserted anew, which keeps the tree good. A steady motion inserts a
/// leaf once in 40 frames.
const REFITS_PER_INSERTION: u8 = 4;

/// Is the share of the leaves that may be inserted anew between two walks, as the number by which
/// their count is divided, and a number that may be in any case. Where all boxes move, an
/// insertion costs as much as some twenty updates, and without a limit all of them would come in
/// the same frame.
const LEAVES_PER_INSERTION: usize = 256;
const FEWEST_INSERTIONS: usize = 16;

/// Is the share of the leaves that may have the boxes above them grow between two walks, before
/// all boxes are left to be made anew, and a number that may in any case. Each grows boxes at
/// several places in memory; making them anew goes through the memory in order.
const LEAVES_PER_WIDENING: usize = 64;
const FEWEST_WIDENINGS: usize = 64;

/// Is the factor by which the half-area of a fat box may exceed what its box needs before it is
/// made smaller. A box that has come to rest after a fast motion then costs walks no more than
/// sixteen boxes of its own size.
const LARGEST_FAT_RATIO: f32 = 16.0;

/// Finds boxes, which are known by the indices that their owner gives them.
#[derive(Debug, Default)]
pub(crate) struct BoundsTree {
    /// Has an entry for each index.
    leaves: Vec<Leaf>,
    /// Holds the nodes, if each of their boxes holds those below it.
    ready: OnceLock<Nodes>,
    /// Holds the nodes otherwise, until the next walk. Their links are right.
    stale: Mutex<Nodes>,
    /// States that the tree was walked since the next two were set to 0.
    was_walked: AtomicBool,
    widenings: usize,
    insertions: usize,
}

/// Is what is known of the box of an index.
#[derive(Clone, Copy, Debug)]
struct Leaf {
    /// Is the fat box.
    fat: Aabb,
    /// Is the node, `NONE` where no box has the index.
    node: u32,
    /// Counts how often the fat box was replaced since the leaf was inserted.
    refits: u8,
}

impl Leaf {
    const NOTHING: Self = Self {
        fat: Aabb::EMPTY,
        node: NONE,
        refits: 0,
    };
}

impl BoundsTree {
    /// Replaces all boxes by those of a list, whose places are their indices. Empty ones are left
    /// out. The tree is as good as one that is made at once can be: each box of it divides its
    /// members at the median of their middles.
    pub(crate) fn rebuild(&mut self, bounds: impl Iterator<Item = Aabb>) {
        self.leaves.clear();
        self.leaves.extend(bounds.map(|fat| Leaf {
            fat,
            ..Leaf::NOTHING
        }));
        let all = (0u32..).zip(&self.leaves);
        let members = all.filter(|(_, leaf)| !leaf.fat.is_empty());
        let mut members: Vec<(u32, Aabb)> = members.map(|(index, l)| (index, l.fat)).collect();
        let mut nodes = std::mem::take(self.nodes_mut());
        nodes.clear();
        if !members.is_empty() {
            nodes.root = self.build(&mut nodes, &mut members);
        }
        self.ready = OnceLock::from(nodes);
    }

    /// Adds the nodes over `members`, which are not empty, and returns the highest.
    fn build(&mut self, nodes: &mut Nodes, members: &mut [(u32, Aabb)]) -> u32 {
        if let [(index, bounds)] = *members {
            let node = nodes.add(Node::leaf(index, bounds));
            self.leaves[index as usize].node = node;
            return node;
        }
        let middle = |bounds: &Aabb| bounds.min + bounds.max;
        let bounds = members
            .iter()
            .fold(Aabb::EMPTY, |all, (_, b)| join(&all, b));
        let middles = Aabb::from_points(members.iter().map(|(_, bounds)| middle(bounds)));
        let axis = (middles.max - middles.min).max_position();
        let half = members.len() / 2;
        members.select_nth_unstable_by(half, |a, b| {
            middle(&a.1)[axis].total_cmp(&middle(&b.1)[axis])
        });
        let (low, high) = members.split_at_mut(half);
        let node = nodes.add(Node {
            bounds,
            links: [NONE; 2],
        });
        let links = [self.build(nodes, low), self.build(nodes, high)];
        nodes.nodes[node as usize].links = links;
        for child in links {
            nodes.parents[child as usize] = node;
        }
        node
    }

    /// Sets the box of an index, which may be new, from `before`, the box that it had last.
    pub(crate) fn set(&mut self, index: u32, before: &Aabb, bounds: &Aabb) {
        let place = index as usize;
        if place >= self.leaves.len() {
            self.leaves.resize(place + 1, Leaf::NOTHING);
        }
        let leaf = self.leaves[place];
        if leaf.node == NONE {
            if !bounds.is_empty() {
                self.insert(index, *bounds);
            }
            return;
        }
        if bounds.is_empty() {
            self.nodes_mut().remove(leaf.node);
            self.leaves[place] = Leaf::NOTHING;
            return;
        }
        let escapes = !holds(&leaf.fat, bounds);
        // A fat box is no smaller than its box, which settles the matter for most.
        let may_be_fat =
            |needed: &Aabb| half_area(&leaf.fat) <= LARGEST_FAT_RATIO * half_area(needed);
        if !escapes && may_be_fat(bounds) {
            return;
        }
        let ahead = fat_box(before, bounds);
        if escapes || !may_be_fat(&ahead) {
            self.replace_fat_box(index, ahead, escapes);
        }
    }

    /// Sets the fat box of an index that has a leaf. Unless the box `escapes` from the one before,
    /// its leaf is inserted anew if possible, since the boxes above it may be too large as well.
    fn replace_fat_box(&mut self, index: u32, ahead: Aabb, escapes: bool) {
        if *self.was_walked.get_mut() {
            *self.was_walked.get_mut() = false;
            (self.widenings, self.insertions) = (0, 0);
        }
        let count = self.leaves.len();
        let Leaf { node, refits, .. } = self.leaves[index as usize];
        let is_due = !escapes || refits >= REFITS_PER_INSERTION;
        if is_due && self.insertions < FEWEST_INSERTIONS + count / LEAVES_PER_INSERTION {
            self.insertions += 1;
            self.nodes_mut().remove(node);
            self.insert(index, ahead);
            return;
        }
        self.leaves[index as usize] = Leaf {
            fat: ahead,
            node,
            refits: refits.saturating_add(1),
        };
        self.widenings += 1;
        if let Some(nodes) = self.ready.get_mut() {
            if self.widenings <= FEWEST_WIDENINGS + count / LEAVES_PER_WIDENING {
                nodes.widen(node, &ahead);
            } else if let Some(nodes) = self.ready.take() {
                self.stale = Mutex::new(nodes);
            }
        }
    }

    fn insert(&mut self, index: u32, fat: Aabb) {
        let node = self.nodes_mut().insert(index, fat);
        self.leaves[index as usize] = Leaf {
            fat,
            node,
            refits: 0,
        };
    }

    /// Returns the nodes, whose boxes need not hold those below them.
    fn nodes_mut(&mut self) -> &mut Nodes {
        match self.ready.get_mut() {
            Some(nodes) => nodes,
            None => self.stale.get_mut().unwrap_or_else(PoisonError::into_inner),
        }
    }

    /// Returns the nodes, whose boxes hold those below them.
    fn nodes(&self) -> &Nodes {
        self.ready.get_or_init(|| {
            let mut stale = self.stale.lock().unwrap_or_else(PoisonError::into_inner);
            let mut nodes = std::mem::take(&mut *stale);
            nodes.refit(|index| self.leaves[index as usize].fat);
            nodes
        })
    }

    /// Visits the tree from its root: calls `meet` with the index of every box for which `enters`
    /// returns true. `enters` is called for the boxes above it first and must return true for each
    /// of these; `state` is passed to both.
    pub(crate) fn walk<S>(
        &self,
        state: &mut S,
        enters: impl FnMut(&S, &Aabb) -> bool,
        meet: impl FnMut(&mut S, u32),
    ) {
        self.was_walked.store(true, Ordering::Relaxed);
        self.nodes().walk(state, enters, meet);
    }
}

/// Returns the fat box (Catto 2019) of a box that moves on as it did from `before`: where it will
/// be, and a quarter of that way to all sides. The way counts up to the size of the box.
fn fat_box(before: &Aabb, bounds: &Aabb) -> Aabb {
    let moved = (bounds.min - before.min) * FRAMES_AHEAD;
    let largest = (bounds.max - bounds.min).max_element();
    let way = moved.clamp(glam::Vec3::splat(-largest), glam::Vec3::splat(largest));
    let around = 0.25 * way.abs().max_element();
    let fat = Aabb {
        min: bounds.min + way.min(glam::Vec3::ZERO) - around,
        max: bounds.max + way.max(glam::Vec3::ZERO) + around,
    };
    // The box before may have been empty, and the sums may overflow.
    if fat.is_finite() && holds(&fat, bounds) {
        fat
    } else {
        *bounds
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::Vec3;

    /// Checks over random insertions, moves and removals that a walk meets every box that overlaps
    /// a volume, and each at most once, that all links agree, and that the tree stays shallow even
    /// where boxes come in the order of a grid.
    #[test]
    fn walks_meet_all_that_overlaps() {
        let mut state = 1_u32;
        let mut random = || {
            state = state.wrapping_mul(747_796_405).wrapping_add(2_891_336_453);
            (state >> 8) as f32 / (1 << 24) as f32
        };
        let mut tree = BoundsTree::default();
        let mut boxes = vec![Aabb::EMPTY; 1500];
        for step in 0..40_000 {
            let index = if step < 1500 {
                step
            } else {
                (random() * 1500.0) as usize
            };
            let place = if step < 1500 {
                Vec3::new((step % 39) as f32, 0.0, (step / 39) as f32)
            } else {
                Vec3::new(random(), random() * 0.1, random()) * 39.0
            };
            let before = boxes[index];
            let bounds = match (random() * 20.0) as u32 {
                0 => Aabb::EMPTY,
                1 | 2 => Aabb::new(place, place),
                3 => Aabb::new(place - 30.0 * random(), place + 30.0 * random()),
                _ if before.is_empty() || step < 1500 => Aabb::new(place, place + random()),
                _ => {
                    let way = Vec3::new(random() - 0.5, 0.0, random() - 0.5) * 0.4;
                    Aabb::new(before.min + way, before.max + way)
                }
            };
            tree.set(index as u32, &before, &bounds);
            boxes[index] = bounds;
            if step == 9_999 || step == 19_999 {
                tree.rebuild(boxes.iter().copied());
            }
            if step % 50 != 0 {
                continue;
            }
            let volume = Aabb::new(place - 3.0 * random(), place + 3.0 * random());
            let overlap = |a: &Aabb| a.min.cmple(volume.max).all() && a.max.cmpge(volume.min).all();
            let mut met = Vec::new();
            tree.walk(
                &mut met,
                |_, around| overlap(around),
                |met, index| met.push(index),
            );
            met.sort_unstable();
            assert!(
                met.windows(2).all(|pair| pair[0] < pair[1]),
                "each is met once"
            );
            met.retain(|index| overlap(&boxes[*index as usize]));
            let wanted = (0u32..)
                .zip(&boxes)
                .filter(|(_, b)| !b.is_empty() && overlap(b));
            assert_eq!(
                met,
                wanted.map(|(index, _)| index).collect::<Vec<_>>(),
                "step {step}"
            );
        }
        let nodes = tree.nodes();
        let depth = |mut node: u32| {
            let mut depth = 0;
            while nodes.parents[node as usize] != NONE {
                let parent = nodes.parents[node as usize];
                let above = &nodes.nodes[parent as usize];
                assert!(above.links.contains(&node));
                assert!(holds(&above.bounds, &nodes.nodes[node as usize].bounds));
                (node, depth) = (parent, depth + 1);
            }
            depth
        };
        let leaves = tree.leaves.iter().filter(|leaf| leaf.node != NONE);
        let deepest = leaves.map(|leaf| depth(leaf.node)).max();
        // A tree whose halves are equal is 11 deep. After 20 000 changes, most of them moves,
        // rotations are to keep it within three times that.
        assert!(deepest <= Some(33), "{deepest:?}");
    }
}
