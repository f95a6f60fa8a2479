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
//! ```text
//! restructure.rs  how leaves are added and removed
//! ```

mod restructure;

use crate::Aabb;
use restructure::{half_area, holds, join};

/// Marks a link that leads nowhere.
const NONE: u32 = u32::MAX;

/// Is the number of frames for which the fat box around a moving box holds it, if its velocity
/// stays the same. So the tree is touched in one frame of eight for each box that moves steadily.
const FRAMES_AHEAD: f32 = 8.0;

/// Is the number of times that a box may leave its fat box and have the boxes above it grow, which
/// is cheap, before its leaf is inserted anew, which keeps the tree good. A steady motion inserts a
/// leaf once in 40 frames.
const REFITS_PER_INSERTION: u8 = 4;

/// Is the factor by which the half-area of a fat box may exceed what its box needs before it is
/// made smaller. A box that has come to rest after a fast motion then costs walks no more than
/// sixteen boxes of its own size.
const LARGEST_FAT_RATIO: f32 = 16.0;

/// Finds boxes, which are known by the indices that their owner gives them.
#[derive(Clone, Debug)]
pub(crate) struct BoundsTree {
    nodes: Vec<Node>,
    /// Holds the parent of each node, `NONE` for the root and for nodes that are not in use.
    parents: Vec<u32>,
    /// Holds the nodes that are not in use.
    spare: Vec<u32>,
    /// Holds for each index the node that holds it, `NONE` where no box has the index.
    leaves: Vec<u32>,
    /// Counts for each index how often its fat box was replaced since its leaf was inserted.
    refits: Vec<u8>,
    root: u32,
}

#[derive(Clone, Copy, Debug)]
struct Node {
    bounds: Aabb,
    /// Holds the two children, or the index of a box and `NONE`.
    links: [u32; 2],
}

impl Node {
    fn leaf(index: u32, bounds: Aabb) -> Self {
        Self {
            bounds,
            links: [index, NONE],
        }
    }

    fn is_leaf(&self) -> bool {
        self.links[1] == NONE
    }
}

impl Default for BoundsTree {
    fn default() -> Self {
        Self {
            nodes: Vec::new(),
            parents: Vec::new(),
            spare: Vec::new(),
            leaves: Vec::new(),
            refits: Vec::new(),
            root: NONE,
        }
    }
}

impl BoundsTree {
    /// Replaces all boxes by those of a list, whose places are their indices. Empty ones are left
    /// out. The tree is as good as one that is made at once can be: each box of it divides its
    /// members at the median of their middles.
    pub fn rebuild(&mut self, bounds: &[Aabb]) {
        self.nodes.clear();
        self.parents.clear();
        self.spare.clear();
        self.leaves.clear();
        self.leaves.resize(bounds.len(), NONE);
        self.refits.clear();
        self.refits.resize(bounds.len(), 0);
        let indices = (0u32..)
            .zip(bounds)
            .filter(|(_, bounds)| !bounds.is_empty());
        let mut members: Vec<(u32, Aabb)> = indices.map(|(index, b)| (index, *b)).collect();
        self.root = if members.is_empty() {
            NONE
        } else {
            self.build(&mut members)
        };
    }

    /// Adds the nodes over `members`, which are not empty, and returns the highest.
    fn build(&mut self, members: &mut [(u32, Aabb)]) -> u32 {
        if let [(index, bounds)] = *members {
            let node = self.add(Node::leaf(index, bounds));
            self.leaves[index as usize] = node;
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
        let node = self.add(Node {
            bounds,
            links: [NONE; 2],
        });
        let links = [self.build(low), self.build(high)];
        self.nodes[node as usize].links = links;
        for child in links {
            self.parents[child as usize] = node;
        }
        node
    }

    /// Sets the box of an index, which may be new, from `before`, the box that it had last.
    pub fn set(&mut self, index: u32, before: &Aabb, bounds: &Aabb) {
        let place = index as usize;
        if place >= self.leaves.len() {
            self.leaves.resize(place + 1, NONE);
            self.refits.resize(place + 1, 0);
        }
        let leaf = self.leaves[place];
        if leaf == NONE {
            if !bounds.is_empty() {
                self.refits[place] = 0;
                self.insert(index, *bounds);
            }
            return;
        }
        if bounds.is_empty() {
            self.remove(leaf);
            self.leaves[place] = NONE;
            return;
        }
        let fat = self.nodes[leaf as usize].bounds;
        let escapes = !holds(&fat, bounds);
        let ahead = fat_box(before, bounds);
        if !escapes && half_area(&fat) <= LARGEST_FAT_RATIO * half_area(&ahead) {
            return;
        }
        if escapes && self.refits[place] < REFITS_PER_INSERTION {
            self.refits[place] += 1;
            self.nodes[leaf as usize].bounds = ahead;
            self.widen_above(leaf, &ahead);
        } else {
            self.refits[place] = 0;
            self.remove(leaf);
            self.insert(index, ahead);
        }
    }

    /// Visits the tree from its root: calls `meet` with the index of every box for which `enters`
    /// returns true. `enters` is called for the boxes above it first and must return true for each
    /// of these; `state` is passed to both.
    pub fn walk<S>(
        &self,
        state: &mut S,
        mut enters: impl FnMut(&S, &Aabb) -> bool,
        mut meet: impl FnMut(&mut S, u32),
    ) {
        if self.root == NONE {
            return;
        }
        // The tree is rarely deeper; what has no place here goes to the heap.
        let (mut stack, mut height) = ([NONE; 64], 0);
        let mut beyond = Vec::new();
        let mut next = Some(self.root);
        while let Some(at) = next {
            let node = &self.nodes[at as usize];
            if enters(state, &node.bounds) {
                if node.is_leaf() {
                    meet(state, node.links[0]);
                } else {
                    if height < stack.len() {
                        stack[height] = node.links[1];
                        height += 1;
                    } else {
                        beyond.push(node.links[1]);
                    }
                    next = Some(node.links[0]);
                    continue;
                }
            }
            next = beyond.pop().or_else(|| {
                height = height.checked_sub(1)?;
                Some(stack[height])
            });
        }
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
                tree.rebuild(&boxes);
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
        let depth = |mut node: u32| {
            let mut depth = 0;
            while tree.parents[node as usize] != NONE {
                let parent = tree.parents[node as usize];
                let above = &tree.nodes[parent as usize];
                assert!(above.links.contains(&node));
                assert!(holds(&above.bounds, &tree.nodes[node as usize].bounds));
                (node, depth) = (parent, depth + 1);
            }
            depth
        };
        let leaves = tree.leaves.iter().filter(|leaf| **leaf != NONE);
        let deepest = leaves.map(|leaf| depth(*leaf)).max();
        // A tree whose halves are equal is 11 deep. After 20 000 changes, most of them moves,
        // rotations are to keep it within three times that.
        assert!(deepest <= Some(33), "{deepest:?}");
    }
}
