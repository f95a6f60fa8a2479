//! Holds the nodes of a tree of boxes.

use crate::Aabb;

/// Marks a link that leads nowhere.
pub(super) const NONE: u32 = u32::MAX;

/// Holds nodes with the links between them.
#[derive(Debug)]
pub(super) struct Nodes {
    pub nodes: Vec<Node>,
    /// Holds the parent of each node, `NONE` for the root and for nodes that are not in use.
    pub parents: Vec<u32>,
    /// Holds the nodes that are not in use.
    pub spare: Vec<u32>,
    pub root: u32,
    /// Holds the nodes in the order of their refit; it is reused for its memory.
    order: Vec<u32>,
}

#[derive(Clone, Copy, Debug)]
pub(super) struct Node {
    pub bounds: Aabb,
    /// Holds the two children, or the index of a box and `NONE`.
    pub links: [u32; 2],
}

impl Node {
    pub(super) fn leaf(index: u32, bounds: Aabb) -> Self {
        Self {
            bounds,
            links: [index, NONE],
        }
    }

    pub(super) fn is_leaf(&self) -> bool {
        self.links[1] == NONE
    }
}

impl Default for Nodes {
    fn default() -> Self {
        Self {
            nodes: Vec::new(),
            parents: Vec::new(),
            spare: Vec::new(),
            root: NONE,
            order: Vec::new(),
        }
    }
}

impl Nodes {
    /// Removes all nodes.
    pub(super) fn clear(&mut self) {
        self.nodes.clear();
        self.parents.clear();
        self.spare.clear();
        self.root = NONE;
    }

    /// Adds a node without a parent.
    pub(super) fn add(&mut self, node: Node) -> u32 {
        if let Some(at) = self.spare.pop() {
            self.nodes[at as usize] = node;
            self.parents[at as usize] = NONE;
            return at;
        }
        self.nodes.push(node);
        self.parents.push(NONE);
        self.nodes.len() as u32 - 1
    }

    /// Sets the box of a leaf and makes all boxes above it hold it.
    pub(super) fn widen(&mut self, leaf: u32, bounds: &Aabb) {
        self.nodes[leaf as usize].bounds = *bounds;
        let mut at = self.parents[leaf as usize];
        while at != NONE {
            let node = &mut self.nodes[at as usize];
            if holds(&node.bounds, bounds) {
                break;
            }
            node.bounds = join(&node.bounds, bounds);
            at = self.parents[at as usize];
        }
    }

    /// Makes each box the smallest around those below it, from the leaves up, whose boxes
    /// `bounds_of` returns by their indices. That costs less than widening the boxes above each
    /// leaf where many leaves have moved.
    pub(super) fn refit(&mut self, bounds_of: impl Fn(u32) -> Aabb) {
        self.order.clear();
        let mut stack = Vec::new();
        let mut next = (self.root != NONE).then_some(self.root);
        // Every node comes before those below it, in the order in which a tree that was made at
        // once has them in memory.
        while let Some(at) = next {
            self.order.push(at);
            let node = &mut self.nodes[at as usize];
            next = if node.is_leaf() {
                node.bounds = bounds_of(node.links[0]);
                stack.pop()
            } else {
                stack.push(node.links[1]);
                Some(node.links[0])
            };
        }
        for &at in self.order.iter().rev() {
            let node = &self.nodes[at as usize];
            if !node.is_leaf() {
                let [first, second] = node.links.map(|child| self.nodes[child as usize].bounds);
                self.nodes[at as usize].bounds = join(&first, &second);
            }
        }
    }

    /// Visits the nodes from the root, as [`BoundsTree::walk`](super::BoundsTree::walk) does.
    pub(super) fn walk<S>(
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

/// Returns the box around two boxes without a NaN.
pub(super) fn join(a: &Aabb, b: &Aabb) -> Aabb {
    Aabb {
        min: a.min.min(b.min),
        max: a.max.max(b.max),
    }
}

/// Returns whether the first box holds all of the second.
pub(super) fn holds(a: &Aabb, b: &Aabb) -> bool {
    a.min.cmple(b.min).all() && a.max.cmpge(b.max).all()
}

/// Returns half the area of a box's surface; it is infinite for a box that is too large.
pub(super) fn half_area(bounds: &Aabb) -> f32 {
    let size = bounds.max - bounds.min;
    size.x * size.y + size.y * size.z + size.z * size.x
}
