//! Holds the casters of a frame with the values that their methods returned.

use std::num::NonZeroU32;

use crate::Aabb;
use crate::cast::instances::Instance;
use crate::cast::mesh_geometry::MeshGeometry;
use crate::cast::{CasterInstances, Revision, ShadowCaster};
use crate::fit::CasterShape;

/// Holds what the methods of a caster returned in a frame, apart from its bounds, or what they say
/// of one of its instances.
#[derive(Clone, Copy, Debug)]
pub(crate) struct CasterFacts {
    /// Is the index of the caster in the engine's list.
    pub listed: u32,
    /// Is the index among the instances of the caster; `None` for one that draws itself.
    pub instance: Option<u32>,
    /// Is equal for instances that are drawn in one call, and rarely equal for others; `None` for a
    /// caster that draws itself.
    pub batch: Option<NonZeroU32>,
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
    /// Is the index of the instance where the caster consists of instances
    /// ([`ShadowCaster::instances`]). Its matrix is not finite, or takes the bounds of the mesh to
    /// infinity. The other instances of the caster keep their shadows.
    pub instance: Option<usize>,
    /// Is the value that was given.
    pub bounds: Aabb,
}

/// Returns the bounds if they are finite or empty. Otherwise adds them to `broken` and returns
/// empty ones.
pub(crate) fn sound_bounds(
    place: (&'static str, usize),
    bounds: Aabb,
    broken: &mut Vec<BrokenBounds>,
) -> Aabb {
    sound_bounds_of(place, None, bounds, broken)
}

/// Does the same for an instance of a caster.
fn sound_bounds_of(
    (field, index): (&'static str, usize),
    instance: Option<usize>,
    bounds: Aabb,
    broken: &mut Vec<BrokenBounds>,
) -> Aabb {
    if bounds.is_empty() || bounds.is_finite() {
        return bounds;
    }
    broken.push(BrokenBounds {
        field,
        index,
        instance,
        bounds,
    });
    Aabb::EMPTY
}

/// Holds the casters of a frame. Each of their methods but `pipeline`, `instances` and `draw` is
/// called once a frame, and all views use the values returned, so that a caster whose values change
/// in between cannot contradict itself.
///
/// A caster that consists of instances counts as many casters, one for each instance: wherever else
/// a caster is told by an index, the index is one into these lists.
#[derive(Clone, Copy)]
pub(crate) struct FrameCasters<'a> {
    /// Is the engine's list.
    listed: &'a [&'a dyn ShadowCaster],
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
    /// Returns the caster at `index`, or the one that the instance at `index` belongs to.
    pub fn caster(&self, index: u32) -> &'a dyn ShadowCaster {
        self.listed[self.facts(index).listed as usize]
    }

    /// Returns the instance at `index` with its geometry. Returns `None` for a caster that draws
    /// itself, and for one that no longer has the instance that it had when it was asked.
    pub fn instance(&self, index: u32) -> Option<(&'a MeshGeometry, &'a Instance)> {
        let instance = self.facts(index).instance?;
        let CasterInstances {
            geometry,
            instances,
            ..
        } = self.caster(index).instances()?;
        Some((geometry, instances.get(instance as usize)?))
    }

    /// Returns the index in the engine's list of the caster at `index`.
    pub fn listed_index(&self, index: u32) -> usize {
        self.facts(index).listed as usize
    }

    /// Returns what the methods of the caster at `index` returned.
    pub fn facts(&self, index: u32) -> &'a CasterFacts {
        &self.facts[index as usize]
    }

    pub fn len(&self) -> usize {
        self.facts.len()
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
            let (casts, is_receiver) = (caster.casts(), caster.receives());
            let place = (field, index);
            let mut add = |bounds, shape, facts| {
                if is_receiver {
                    receives(self.facts.len() as u32, bounds);
                }
                self.bounds.push(if casts { bounds } else { Aabb::EMPTY });
                self.shapes.push(shape);
                self.facts.push(facts);
            };
            let Some(instances) = caster.instances() else {
                let facts = CasterFacts {
                    listed: index as u32,
                    instance: None,
                    batch: None,
                    revision: caster.revision(),
                    triangles: caster.triangles(),
                    same_in_every_view: caster.same_in_every_view(),
                    keeps_pass_state: caster.keeps_pass_state(),
                };
                let bounds = sound_bounds(place, caster.bounds(), broken);
                add(bounds, caster.shape(), facts);
                continue;
            };
            let CasterInstances {
                geometry,
                shape_model,
                instances,
            } = instances;
            let triangles = geometry.triangles();
            let batches = [false, true].map(|mirrors| Some(batch_hash(geometry, mirrors)));
            for (number, instance) in instances.iter().enumerate() {
                let bounds = instance.bounds_render;
                let facts = CasterFacts {
                    listed: index as u32,
                    instance: Some(number as u32),
                    batch: batches[usize::from(instance.mirrors)],
                    revision: Some(instance.revision),
                    triangles,
                    same_in_every_view: true,
                    keeps_pass_state: true,
                };
                let bounds = sound_bounds_of(place, Some(number), bounds, broken);
                let shape = match geometry.matrix_layout() {
                    Some(_) => shape_model.transformed(&instance.render_from_model),
                    None => shape_model,
                };
                add(bounds, shape, facts);
            }
        }
        FrameCasters {
            listed: casters,
            bounds: &self.bounds,
            shapes: &self.shapes,
            facts: &self.facts,
            field,
            broken,
        }
    }
}

/// Returns a number that is equal for instances that one call draws, and rarely equal for others.
fn batch_hash(geometry: &MeshGeometry, mirrors: bool) -> NonZeroU32 {
    let pipeline = geometry.pipeline(mirrors).sort_key();
    let mixed = (geometry.sort_key() ^ pipeline).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    // The upper bits of the product depend on all bits of the factors.
    NonZeroU32::new((mixed >> 32) as u32).unwrap_or(NonZeroU32::MIN)
}
