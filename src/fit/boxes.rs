//! Defines lists of boxes that are walked from end to end, or through a tree where there is one.

use crate::Aabb;
use crate::fit::bounds_tree::BoundsTree;
use crate::fit::caster_shape::CasterShape;

/// Is what a box may have to do with shadows.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) enum Role {
    #[default]
    Casts,
    Receives,
}

/// Holds the bounds of a caster with what is known of its surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct CasterBox {
    /// Is empty for one that neither casts nor receives.
    pub bounds: Aabb,
    pub casts: bool,
    pub receives: bool,
    pub shape: CasterShape,
}

impl CasterBox {
    /// Is the box of no caster.
    pub(crate) const NOTHING: Self = Self {
        bounds: Aabb::EMPTY,
        casts: false,
        receives: false,
        shape: CasterShape::Any,
    };

    /// Returns the bounds, which are empty for one that has not this role.
    fn bounds_as(&self, role: Role) -> &Aabb {
        let has_role = match role {
            Role::Casts => self.casts,
            Role::Receives => self.receives,
        };
        if has_role { &self.bounds } else { &Aabb::EMPTY }
    }
}

/// Holds boxes by index.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Boxes<'a> {
    pub members: &'a [CasterBox],
    /// Selects the boxes that count; all others count as empty.
    pub role: Role,
    /// Finds the boxes that are not empty, and may find others; `None` where all of them are to be
    /// looked at.
    pub tree: Option<&'a BoundsTree>,
}

impl<'a> Boxes<'a> {
    /// Returns the box at an index, which is empty where it does not count.
    pub(crate) fn at(&self, index: u32) -> &'a Aabb {
        self.members[index as usize].bounds_as(self.role)
    }

    /// Returns what is known of the surface in the box at an index.
    pub(crate) fn shape(&self, index: u32) -> CasterShape {
        self.members[index as usize].shape
    }

    /// Returns the boxes that are not empty, with their indices.
    pub(crate) fn iter(self) -> impl Iterator<Item = (u32, &'a Aabb)> {
        let members = (0u32..).zip(self.members);
        let boxes = members.map(move |(index, member)| (index, member.bounds_as(self.role)));
        boxes.filter(|(_, bounds)| !bounds.is_empty())
    }

    /// Calls `meet` with each box that is not empty, except where `enters` returns false for a box
    /// around it. So `enters` may refuse boxes of which no part matters, in the present state. It
    /// must never refuse a box that holds one which `meet` would use.
    pub(crate) fn walk<S>(
        &self,
        state: &mut S,
        enters: impl FnMut(&S, &Aabb) -> bool,
        mut meet: impl FnMut(&mut S, u32, &'a Aabb),
    ) {
        match self.tree {
            None => {
                for (index, bounds) in self.iter() {
                    meet(state, index, bounds);
                }
            }
            Some(tree) => tree.walk(state, enters, |state, index| {
                let bounds = self.at(index);
                if !bounds.is_empty() {
                    meet(state, index, bounds);
                }
            }),
        }
    }
}
