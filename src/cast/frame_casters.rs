//! Holds the casters of a frame with the values that their methods returned.

use crate::Aabb;
use crate::cast::{Revision, ShadowCaster};
use crate::fit::CasterShape;

/// Holds what the methods of a caster returned in a frame, apart from its bounds.
#[derive(Clone, Copy, Debug)]
pub(crate) struct CasterFacts {
    pub revision: Option<Revision>,
    pub triangles: u32,
    pub same_in_every_view: bool,
    pub keeps_pass_state: bool,
}

/// Names bounds of a frame that have a NaN or an infinite corner and are not empty. The object that
/// they bound is left out of the frame: it neither casts nor receives, and all other objects keep
/// their shadows.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct BrokenBounds {
    /// Is the path of the list: `ShadowFrameDescriptor::casters` or
    /// `ShadowFrameDescriptor::receivers`.
    pub field: &'static str,
    /// Is the index in the list.
    pub index: usize,
    /// Is the value that was given.
    pub bounds: Aabb,
}

/// Returns the bounds if they are finite or empty. Otherwise adds them to `broken` and returns
/// empty ones.
pub(crate) fn sound_bounds(
    (field, index): (&'static str, usize),
    bounds: Aabb,
    broken: &mut Vec<BrokenBounds>,
) -> Aabb {
    if bounds.is_empty() || bounds.is_finite() {
        return bounds;
    }
    broken.push(BrokenBounds {
        field,
        index,
        bounds,
    });
    Aabb::EMPTY
}

/// Holds the casters of a frame. Each of their methods but `pipeline` and `draw` is called once a
/// frame, and all views use the values returned, so that a caster whose values change in between
/// cannot contradict itself.
#[derive(Clone, Copy)]
pub(crate) struct FrameCasters<'a> {
    pub casters: &'a [&'a dyn ShadowCaster],
    /// Has one entry per caster, empty for one that does not cast.
    pub bounds: &'a [Aabb],
    /// Has one entry per caster.
    pub shapes: &'a [CasterShape],
    /// Has one entry per caster.
    pub facts: &'a [CasterFacts],
    /// Is the path of the list in the caller's frame, for errors.
    pub field: &'static str,
    /// Holds the bounds of the frame that were left out.
    pub broken: &'a [BrokenBounds],
}

impl<'a> FrameCasters<'a> {
    /// Returns the caster at `index` of the engine's list.
    pub fn caster(&self, index: u32) -> &'a dyn ShadowCaster {
        self.casters[index as usize]
    }

    /// Returns what the methods of the caster at `index` returned.
    pub fn facts(&self, index: u32) -> &'a CasterFacts {
        &self.facts[index as usize]
    }

    pub fn len(&self) -> usize {
        self.casters.len()
    }
}

/// Holds the values that a frame's casters returned, in lists that are reused from frame to frame.
#[derive(Debug, Default)]
pub(crate) struct CasterAnswers {
    bounds: Vec<Aabb>,
    shapes: Vec<CasterShape>,
    facts: Vec<CasterFacts>,
}

impl CasterAnswers {
    /// Calls the methods of all casters, and `receives` with the index and bounds of those that
    /// receive. `field` is the path of the list in the caller's frame. Bounds that are neither
    /// finite nor empty are added to `broken`.
    pub fn ask<'a>(
        &'a mut self,
        field: &'static str,
        casters: &'a [&'a dyn ShadowCaster],
        broken: &'a mut Vec<BrokenBounds>,
        mut receives: impl FnMut(u32, Aabb),
    ) -> FrameCasters<'a> {
        self.bounds.clear();
        self.shapes.clear();
        self.facts.clear();
        for (index, caster) in casters.iter().enumerate() {
            let bounds = sound_bounds((field, index), caster.bounds(), broken);
            if caster.receives() {
                receives(index as u32, bounds);
            }
            let casts = caster.casts();
            self.bounds.push(if casts { bounds } else { Aabb::EMPTY });
            self.shapes.push(caster.shape());
            self.facts.push(CasterFacts {
                revision: caster.revision(),
                triangles: caster.triangles(),
                same_in_every_view: caster.same_in_every_view(),
                keeps_pass_state: caster.keeps_pass_state(),
            });
        }
        FrameCasters {
            casters,
            bounds: &self.bounds,
            shapes: &self.shapes,
            facts: &self.facts,
            field,
            broken,
        }
    }
}
