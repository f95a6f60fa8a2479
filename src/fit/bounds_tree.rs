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

use crate::Aabb;

/// Marks a link that leads nowhere.
const NONE: u32 = u32::MAX;

/// Is the number of frames for which the room that is left around a moving box suffices, if its
/// velocity stays the same.
const FRAMES_AHEAD: f32 = 8.0;

/// Is the number of times that a box may leave the room around it before its place in the tree is
/// chosen anew. In between, the boxes above it grow.
const ESCAPES_PER_PLACE: u8 = 4;

/// Is the factor by which the room around a box may exceed what the box needs, in half-areas,
/// before it is made smaller.
const LARGEST_ROOM: f32 = 16.0;

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
    /// Counts for each index how often its box has left the room around it.
    escapes: Vec<u8>,
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
            escapes: Vec::new(),
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
        self.escapes.clear();
        self.escapes.resize(bounds.len(), 0);
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
            self.escapes.resize(place + 1, 0);
        }
        let leaf = self.leaves[place];
        if leaf == NONE {
            if !bounds.is_empty() {
                self.escapes[place] = 0;
                self.insert(index, *bounds);
            }
            return;
        }
        if bounds.is_empty() {
            self.remove(leaf);
            self.leaves[place] = NONE;
            return;
        }
        let room = self.nodes[leaf as usize].bounds;
        let escapes = !holds(&room, bounds);
        let ahead = ahead(before, bounds);
        if !escapes && half_area(&room) <= LARGEST_ROOM * half_area(&ahead) {
            return;
        }
        if escapes && self.escapes[place] < ESCAPES_PER_PLACE {
            self.escapes[place] += 1;
            self.nodes[leaf as usize].bounds = ahead;
            self.widen_above(leaf, &ahead);
        } else {
            self.escapes[place] = 0;
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

    fn add(&mut self, node: Node) -> u32 {
        if let Some(at) = self.spare.pop() {
            self.nodes[at as usize] = node;
            self.parents[at as usize] = NONE;
            return at;
        }
        self.nodes.push(node);
        self.parents.push(NONE);
        self.nodes.len() as u32 - 1
    }

    /// Adds a leaf where the areas of the boxes above it grow least.
    fn insert(&mut self, index: u32, bounds: Aabb) {
        let leaf = self.add(Node::leaf(index, bounds));
        self.leaves[index as usize] = leaf;
        if self.root == NONE {
            self.root = leaf;
            return;
        }
        let mut beside = self.root;
        loop {
            let node = self.nodes[beside as usize];
            if node.is_leaf() {
                break;
            }
            let with = half_area(&join(&node.bounds, &bounds));
            // Whatever is below, the boxes down to here grow.
            let inherited = with - half_area(&node.bounds);
            let costs = node.links.map(|child| {
                let child = &self.nodes[child as usize];
                let with = half_area(&join(&child.bounds, &bounds));
                if child.is_leaf() {
                    with + inherited
                } else {
                    with - half_area(&child.bounds) + inherited
                }
            });
            if with < costs[0].min(costs[1]) {
                break;
            }
            beside = node.links[usize::from(costs[1] < costs[0])];
        }
        let above = self.parents[beside as usize];
        let parent = self.add(Node {
            bounds: join(&self.nodes[beside as usize].bounds, &bounds),
            links: [beside, leaf],
        });
        self.replace_child(above, beside, parent);
        self.parents[beside as usize] = parent;
        self.parents[leaf as usize] = parent;
        let mut at = above;
        while at != NONE {
            let node = &mut self.nodes[at as usize];
            node.bounds = join(&node.bounds, &bounds);
            self.rotate(at);
            at = self.parents[at as usize];
        }
    }

    /// Removes a leaf and makes the boxes above it smaller.
    fn remove(&mut self, leaf: u32) {
        self.spare.push(leaf);
        let parent = self.parents[leaf as usize];
        if parent == NONE {
            self.root = NONE;
            return;
        }
        let [first, second] = self.nodes[parent as usize].links;
        let sibling = if first == leaf { second } else { first };
        let above = self.parents[parent as usize];
        self.replace_child(above, parent, sibling);
        self.spare.push(parent);
        let mut at = above;
        while at != NONE {
            let [first, second] = self.nodes[at as usize].links.map(|child| {
                let child = &self.nodes[child as usize];
                child.bounds
            });
            let bounds = join(&first, &second);
            if self.nodes[at as usize].bounds == bounds {
                break;
            }
            self.nodes[at as usize].bounds = bounds;
            at = self.parents[at as usize];
        }
    }

    /// Puts `new` in the place of `old` below `parent`, or at the root.
    fn replace_child(&mut self, parent: u32, old: u32, new: u32) {
        self.parents[new as usize] = parent;
        if parent == NONE {
            self.root = new;
            return;
        }
        let links = &mut self.nodes[parent as usize].links;
        links[usize::from(links[1] == old)] = new;
    }

    /// Makes all boxes above a node hold `bounds`.
    fn widen_above(&mut self, node: u32, bounds: &Aabb) {
        let mut at = self.parents[node as usize];
        while at != NONE {
            let node = &mut self.nodes[at as usize];
            if holds(&node.bounds, bounds) {
                break;
            }
            node.bounds = join(&node.bounds, bounds);
            at = self.parents[at as usize];
        }
    }

    /// Exchanges a child of a node with a child of the other child, if that makes the box of the
    /// latter smaller.
    fn rotate(&mut self, at: u32) {
        let [first, second] = self.nodes[at as usize].links;
        let mut best: Option<(f32, [u32; 4])> = None;
        for (sinks, keeps) in [(first, second), (second, first)] {
            let keeper = self.nodes[keeps as usize];
            if keeper.is_leaf() {
                continue;
            }
            let [a, b] = keeper.links;
            for (rises, stays) in [(a, b), (b, a)] {
                let (sinking, staying) = (&self.nodes[sinks as usize], &self.nodes[stays as usize]);
                let saved =
                    half_area(&keeper.bounds) - half_area(&join(&sinking.bounds, &staying.bounds));
                if saved > best.map_or(0.0, |(most, _)| most) {
                    best = Some((saved, [sinks, keeps, rises, stays]));
                }
            }
        }
        let Some((_, [sinks, keeps, rises, stays])) = best else {
            return;
        };
        let bounds = join(
            &self.nodes[sinks as usize].bounds,
            &self.nodes[stays as usize].bounds,
        );
        self.nodes[keeps as usize] = Node {
            bounds,
            links: [sinks, stays],
        };
        self.nodes[at as usize].links = [keeps, rises];
        self.parents[sinks as usize] = keeps;
        self.parents[rises as usize] = at;
    }
}

/// Returns the room for a box that moves on as it did from `before`: where it will be, and a
/// quarter of that way to all sides. The way counts up to the size of the box.
fn ahead(before: &Aabb, bounds: &Aabb) -> Aabb {
    let moved = (bounds.min - before.min) * FRAMES_AHEAD;
    let largest = (bounds.max - bounds.min).max_element();
    let way = moved.clamp(glam::Vec3::splat(-largest), glam::Vec3::splat(largest));
    let around = 0.25 * way.abs().max_element();
    let room = Aabb {
        min: bounds.min + way.min(glam::Vec3::ZERO) - around,
        max: bounds.max + way.max(glam::Vec3::ZERO) + around,
    };
    // The box before may have been empty, and the sums may overflow.
    if room.is_finite() && holds(&room, bounds) {
        room
    } else {
        *bounds
    }
}

/// Returns the box around two boxes without a NaN.
fn join(a: &Aabb, b: &Aabb) -> Aabb {
    Aabb {
        min: a.min.min(b.min),
        max: a.max.max(b.max),
    }
}

fn holds(a: &Aabb, b: &Aabb) -> bool {
    a.min.cmple(b.min).all() && a.max.cmpge(b.max).all()
}

/// Returns half the area of a box's surface; it is infinite for a box that is too large.
fn half_area(bounds: &Aabb) -> f32 {
    let size = bounds.max - bounds.min;
    size.x * size.y + size.y * size.z + size.z * size.x
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
            if step % 10_000 == 9_999 {
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
        // Twice the depth of a tree whose halves are equal is 22.
        assert!(deepest <= Some(32), "{deepest:?}");
    }
}
