//! Adds leaves to the nodes of a tree and removes them, and keeps them good to walk.

use super::nodes::{NONE, Node, Nodes, half_area, join};
use crate::Aabb;

impl Nodes {
    /// Adds a leaf where the areas of the boxes above it grow least, and returns its node.
    pub(super) fn insert(&mut self, index: u32, bounds: Aabb) -> u32 {
        let leaf = self.add(Node::leaf(index, bounds));
        if self.root == NONE {
            self.root = leaf;
            return leaf;
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
        leaf
    }

    /// Removes a leaf and makes the boxes above it smaller.
    pub(super) fn remove(&mut self, leaf: u32) {
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
