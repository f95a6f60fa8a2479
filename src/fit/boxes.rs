//! Defines lists of boxes that are walked from end to end, or through a tree where there is one.

use crate::Aabb;
use crate::fit::bounds_tree::BoundsTree;

/// Holds boxes by index.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Boxes<'a> {
    /// Holds the boxes; empty ones count for nothing.
    pub bounds: &'a [Aabb],
    /// Finds the boxes that are not empty, and may find others; `None` where all of them are to be
    /// looked at.
    pub tree: Option<&'a BoundsTree>,
}

impl<'a> Boxes<'a> {
    /// Returns the box at an index.
    pub fn at(&self, index: u32) -> &'a Aabb {
        &self.bounds[index as usize]
    }

    /// Calls `meet` with each box that is not empty, except where `enters` returns false for a box
    /// around it. So `enters` may refuse boxes of which no part matters, in the present state. It
    /// must never refuse a box that holds one which `meet` would use.
    pub fn walk<S>(
        &self,
        state: &mut S,
        enters: impl FnMut(&S, &Aabb) -> bool,
        mut meet: impl FnMut(&mut S, u32, &'a Aabb),
    ) {
        match self.tree {
            None => {
                for (index, bounds) in (0u32..).zip(self.bounds) {
                    if !bounds.is_empty() {
                        meet(state, index, bounds);
                    }
                }
            }
            Some(tree) => tree.walk(state, enters, |state, index| {
                let bounds = &self.bounds[index as usize];
                if !bounds.is_empty() {
                    meet(state, index, bounds);
                }
            }),
        }
    }

    /// Calls `meet` with each box that is not empty.
    pub fn for_each(&self, mut meet: impl FnMut(u32, &'a Aabb)) {
        for (index, bounds) in (0u32..).zip(self.bounds) {
            if !bounds.is_empty() {
                meet(index, bounds);
            }
        }
    }
}
