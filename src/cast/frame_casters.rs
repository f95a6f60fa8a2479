//! Holds the casters of a frame with the values that their methods returned.

use crate::cast::caster_records::{CasterFacts, CasterRecord, CasterRecords, CastersVersion};
use crate::cast::instances::Instance;
use crate::cast::mesh_geometry::MeshGeometry;
use crate::cast::{CasterInstances, CasterPipeline, Casters, ShadowCaster};
use crate::fit::{Boxes, ChangedBoxes, Role};
use crate::gpu::DepthFormat;
use crate::{Aabb, ShadowError};

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
        instance: None,
        bounds,
    });
    Aabb::EMPTY
}

/// Holds the casters of a frame. Each of their methods but `pipeline`, `instances` and `draw` is
/// called once a frame, or once for each change of a caster in a set. All views use the values
/// returned, so that a caster whose values change in between cannot contradict itself.
///
/// A caster that consists of instances counts as many casters, one for each instance: wherever else
/// a caster is told by an index, the index is one into these lists.
#[derive(Clone, Copy)]
pub(crate) struct FrameCasters<'a> {
    casters: Casters<'a>,
    records: &'a CasterRecords,
    version: CastersVersion,
    /// Is the path of the list in the caller's frame, for errors.
    pub field: &'static str,
    /// Holds the bounds of the frame that were left out.
    pub broken: &'a [BrokenBounds],
}

impl<'a> FrameCasters<'a> {
    /// Calls the methods of the casters of a list, or takes the records of a set. `field` is the
    /// path in the caller's frame. Bounds that are neither finite nor empty are added to `broken`.
    pub(crate) fn new(
        field: &'static str,
        casters: Casters<'a>,
        listed: &'a mut CasterRecords,
        broken: &'a mut Vec<BrokenBounds>,
    ) -> Self {
        let (records, version) = match casters {
            Casters::List(list) => {
                let mut count = 0;
                for (listed_index, caster) in (0u32..).zip(list) {
                    CasterRecord::each(*caster, listed_index, |record| {
                        listed.put(count, &record);
                        count += 1;
                    });
                }
                listed.truncate(count as usize);
                if listed.always_changing > 0 {
                    listed.count_frame();
                }
                (&*listed, listed.version())
            }
            Casters::Set(set) => (set.records(), set.version_of_frame()),
        };
        broken.extend(records.broken.iter().map(|(&index, &bounds)| {
            let CasterFacts {
                listed, instance, ..
            } = records.facts[index as usize];
            BrokenBounds {
                field,
                index: listed as usize,
                instance: instance.map(|instance| instance as usize),
                bounds,
            }
        }));
        Self {
            casters,
            records,
            version,
            field,
            broken,
        }
    }

    /// Returns the caster at `index`, or the one that the instance at `index` belongs to.
    pub(crate) fn caster(&self, index: u32) -> &'a dyn ShadowCaster {
        let listed = self.facts(index).listed;
        match self.casters {
            Casters::List(list) => list[listed as usize],
            Casters::Set(set) => set.caster(listed),
        }
    }

    /// Returns the instance at `index` with its geometry. Returns `None` for a caster that draws
    /// itself, and for one that no longer has the instance that it had when the frame began.
    pub(crate) fn instance(&self, index: u32) -> Option<(&'a MeshGeometry, &'a Instance)> {
        let instance = self.facts(index).instance?;
        let CasterInstances {
            geometry,
            instances,
            ..
        } = self.caster(index).instances()?;
        Some((geometry, instances.get(instance as usize)?))
    }

    /// Returns the index in the engine's list or set of the caster at `index`.
    pub(crate) fn listed_index(&self, index: u32) -> usize {
        self.facts(index).listed as usize
    }

    /// Accepts the pipeline of the caster at `index` if it can draw into a map of `format` on
    /// `device`.
    pub(crate) fn check_pipeline(
        &self,
        index: u32,
        pipeline: &CasterPipeline,
        device: &wgpu::Device,
        format: DepthFormat,
    ) -> Result<(), ShadowError> {
        let (field, index) = (self.field, self.listed_index(index));
        if pipeline.device() != device {
            return Err(ShadowError::CasterDevice { field, index });
        }
        if pipeline.wgpu_pipeline(format).is_none() {
            return Err(ShadowError::CasterFormat {
                field,
                index,
                format,
            });
        }
        Ok(())
    }

    /// Returns what the methods of the caster at `index` returned.
    pub(crate) fn facts(&self, index: u32) -> &'a CasterFacts {
        &self.records.facts[index as usize]
    }

    /// Returns the number of casters, where instances count one by one.
    pub(crate) fn len(&self) -> usize {
        match self.casters {
            Casters::List(_) => self.records.facts.len(),
            Casters::Set(set) => set.count(),
        }
    }

    /// Returns the bounds of those that cast.
    pub(crate) fn casting(&self) -> Boxes<'a> {
        self.boxes(Role::Casts)
    }

    /// Returns the bounds of those that receive.
    pub(crate) fn receiving(&self) -> Boxes<'a> {
        self.boxes(Role::Receives)
    }

    fn boxes(&self, role: Role) -> Boxes<'a> {
        Boxes {
            members: &self.records.boxes,
            role,
            tree: self.records.tree.as_ref(),
        }
    }

    /// Returns the number of the state that all of this is in.
    pub(crate) fn version(&self) -> CastersVersion {
        self.version
    }

    /// Returns the changes since an earlier state, or `None` where they are not known.
    pub(crate) fn changes_since(&self, version: &CastersVersion) -> Option<ChangedBoxes<'a>> {
        self.records.changes(version, &self.version)
    }
}
