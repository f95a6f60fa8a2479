//! Holds the casters of a frame with the values that their methods returned.

use crate::Aabb;
use crate::cast::caster_answers::{CasterAnswer, CasterAnswers, CasterFacts, Content};
use crate::cast::{Casters, ShadowCaster};
use crate::fit::{Boxes, CasterShape};

/// Names bounds of a frame that have a NaN or an infinite corner and are not empty. The object that
/// they bound is left out of the frame: it neither casts nor receives, and all other objects keep
/// their shadows.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct BrokenBounds {
    /// Is the path of the list: `ShadowFrameDescriptor::casters` or
    /// `ShadowFrameDescriptor::receivers`.
    pub field: &'static str,
    /// Is the index in the list, or what [`CasterId::index`](crate::CasterId::index) returns for a
    /// caster of a set.
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
/// frame, or once for each change of a caster in a set. All views use the values returned, so that
/// a caster whose values change in between cannot contradict itself.
#[derive(Clone, Copy)]
pub(crate) struct FrameCasters<'a> {
    casters: Casters<'a>,
    answers: &'a CasterAnswers,
    content: Content,
    /// Is the path of the list in the caller's frame, for errors.
    pub field: &'static str,
    /// Holds the bounds of the frame that were left out.
    pub broken: &'a [BrokenBounds],
}

impl<'a> FrameCasters<'a> {
    /// Asks the casters of a list, or takes the answers of a set. `field` is the path in the
    /// caller's frame. Bounds that are neither finite nor empty are added to `broken`.
    pub fn ask(
        field: &'static str,
        casters: Casters<'a>,
        listed: &'a mut CasterAnswers,
        broken: &'a mut Vec<BrokenBounds>,
    ) -> Self {
        let (answers, content) = match casters {
            Casters::List(list) => {
                for (index, caster) in (0u32..).zip(list) {
                    listed.put(index, &CasterAnswer::of(*caster));
                }
                listed.truncate(list.len());
                if listed.always_changing > 0 {
                    listed.count_frame();
                }
                (&*listed, listed.content())
            }
            Casters::Set(set) => (set.answers(), set.content_of_frame()),
        };
        broken.extend(answers.broken.iter().map(|(index, bounds)| BrokenBounds {
            field,
            index: *index as usize,
            bounds: *bounds,
        }));
        Self {
            casters,
            answers,
            content,
            field,
            broken,
        }
    }

    /// Returns the caster at `index` of the engine's list or set.
    pub fn caster(&self, index: u32) -> &'a dyn ShadowCaster {
        match self.casters {
            Casters::List(list) => list[index as usize],
            Casters::Set(set) => set.caster(index),
        }
    }

    /// Returns what the methods of the caster at `index` returned.
    pub fn facts(&self, index: u32) -> &'a CasterFacts {
        &self.answers.facts[index as usize]
    }

    /// Returns the number of casters.
    pub fn len(&self) -> usize {
        match self.casters {
            Casters::List(list) => list.len(),
            Casters::Set(set) => set.count(),
        }
    }

    /// Returns the bounds of those that cast.
    pub fn casting(&self) -> Boxes<'a> {
        Boxes {
            bounds: &self.answers.casts,
            tree: self.answers.tree.as_ref(),
        }
    }

    /// Returns the bounds of those that receive.
    pub fn receiving(&self) -> Boxes<'a> {
        Boxes {
            bounds: &self.answers.receives,
            tree: self.answers.tree.as_ref(),
        }
    }

    /// Returns the shapes by index.
    pub fn shapes(&self) -> &'a [CasterShape] {
        &self.answers.shapes
    }

    /// Returns the number of the state that all of this is in.
    pub fn content(&self) -> Content {
        self.content
    }
}
