//! Holds what the methods of casters returned, by the casters' indices.

use std::collections::BTreeMap;
use std::num::NonZeroU32;
use std::sync::atomic::{AtomicU64, Ordering};

use crate::Aabb;
use crate::cast::mesh_geometry::MeshGeometry;
use crate::cast::{CasterInstances, Revision, ShadowCaster};
use crate::fit::{BoundsTree, CasterBox, ChangeLog, ChangedBoxes};

/// Holds what the methods of a caster returned, apart from its bounds, or what they say of one of
/// its instances.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct CasterFacts {
    /// Is the index of the caster in the engine's list or set.
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

impl CasterFacts {
    /// States what is known of no caster. The revision keeps it from counting as one that always
    /// changes.
    const NOTHING: Self = Self {
        listed: 0,
        instance: None,
        batch: None,
        revision: Some(Revision::new(0, 0)),
        triangles: 0,
        same_in_every_view: true,
        keeps_pass_state: true,
    };
}

/// Is what the methods of one caster returned, or what they say of one of its instances.
pub(crate) struct CasterRecord {
    member: CasterBox,
    facts: CasterFacts,
}

impl CasterRecord {
    /// Calls the methods of a caster, and then `take` with the record, or with one for each of its
    /// instances. `listed` is the index of the caster in the engine's list or set.
    pub(crate) fn each(
        caster: &(impl ShadowCaster + ?Sized),
        listed: u32,
        mut take: impl FnMut(Self),
    ) {
        let (casts, receives) = (caster.casts(), caster.receives());
        let Some(instances) = caster.instances() else {
            return take(Self {
                member: CasterBox {
                    bounds: caster.bounds(),
                    casts,
                    receives,
                    shape: caster.shape(),
                },
                facts: CasterFacts {
                    listed,
                    instance: None,
                    batch: None,
                    revision: caster.revision(),
                    triangles: caster.triangles(),
                    same_in_every_view: caster.same_in_every_view(),
                    keeps_pass_state: caster.keeps_pass_state(),
                },
            });
        };
        let CasterInstances {
            geometry,
            shape_model,
            instances,
        } = instances;
        let triangles = geometry.triangles();
        let batches = [false, true].map(|mirrors| Some(batch_hash(geometry, mirrors)));
        for (number, instance) in (0u32..).zip(instances) {
            take(Self {
                member: CasterBox {
                    bounds: instance.bounds_render,
                    casts,
                    receives,
                    shape: match geometry.matrix_layout() {
                        Some(_) => shape_model.transformed(&instance.render_from_model),
                        None => shape_model,
                    },
                },
                facts: CasterFacts {
                    listed,
                    instance: Some(number),
                    batch: batches[usize::from(instance.mirrors)],
                    revision: Some(instance.revision),
                    triangles,
                    same_in_every_view: true,
                    keeps_pass_state: true,
                },
            });
        }
    }
}

/// Returns a number that is equal for instances that one call draws, and rarely equal for others.
fn batch_hash(geometry: &MeshGeometry, mirrors: bool) -> NonZeroU32 {
    let pipeline = geometry.pipeline(mirrors).sort_key();
    let mixed = (geometry.sort_key() ^ pipeline).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    // This is Fibonacci hashing (Knuth, The Art of Computer Programming 3, 6.4), by 2^64 over the
    // golden ratio: the upper bits of the product depend on all bits of the factors.
    NonZeroU32::new((mixed >> 32) as u32).unwrap_or(NonZeroU32::MIN)
}

/// Identifies a state of some records: two states with equal numbers are equal.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct CastersVersion {
    /// Identifies the records in the process.
    source: u64,
    /// Is the number of the next change.
    changes: u64,
    /// Counts the frames in which a caster may always look different; 0 where there is none.
    frame: u64,
}

impl CastersVersion {
    /// Returns the number of a state that lasts for one frame.
    pub(crate) fn in_frame(self, frame: u64) -> Self {
        Self {
            frame: frame + 1,
            ..self
        }
    }
}

/// Holds the records of casters. A caster with bounds that are neither finite nor empty counts as
/// one that neither casts nor receives.
#[derive(Debug)]
pub(crate) struct CasterRecords {
    /// Has one entry per caster.
    pub boxes: Vec<CasterBox>,
    pub facts: Vec<CasterFacts>,
    /// Finds casters by their bounds; `None` where none is kept.
    pub tree: Option<BoundsTree>,
    /// Holds the bounds that are neither finite nor empty.
    pub broken: BTreeMap<u32, Aabb>,
    /// Counts the casters that may look different in every frame.
    pub always_changing: usize,
    /// Holds the changes of all entries that cast or receive.
    log: ChangeLog,
    /// Identifies the records in the process.
    source: u64,
    /// Counts the frames in which a caster may always look different; 0 where there is none.
    frame: u64,
}

static NEXT_SOURCE: AtomicU64 = AtomicU64::new(0);

impl Default for CasterRecords {
    fn default() -> Self {
        Self::new(false)
    }
}

impl CasterRecords {
    /// Makes an empty list, with a tree that follows it or without one.
    pub(crate) fn new(has_tree: bool) -> Self {
        Self {
            boxes: Vec::new(),
            facts: Vec::new(),
            tree: has_tree.then(BoundsTree::default),
            broken: BTreeMap::new(),
            always_changing: 0,
            log: ChangeLog::default(),
            source: NEXT_SOURCE.fetch_add(1, Ordering::Relaxed),
            frame: 0,
        }
    }

    /// Returns the number of the present state.
    pub(crate) fn version(&self) -> CastersVersion {
        CastersVersion {
            source: self.source,
            changes: self.log.next(),
            frame: self.frame,
        }
    }

    /// Returns what has changed from one state to another, the present one, or `None` where that
    /// is not known.
    pub(crate) fn changes(
        &self,
        from: &CastersVersion,
        to: &CastersVersion,
    ) -> Option<ChangedBoxes<'_>> {
        let same = from.source == to.source && from.frame == to.frame;
        same.then(|| self.log.since(from.changes)).flatten()
    }

    /// Makes the present state another than that of all frames before.
    pub(crate) fn count_frame(&mut self) {
        self.frame += 1;
    }

    /// Returns the number of entries.
    pub(crate) fn len(&self) -> usize {
        self.facts.len()
    }

    /// Sets the record at `index`, which is at most the number of entries.
    pub(crate) fn put(&mut self, index: u32, record: &CasterRecord) {
        let mut member = record.member;
        let bounds = member.bounds;
        if !self.broken.is_empty() {
            self.broken.remove(&index);
        }
        let is_sound = bounds.is_empty() || bounds.is_finite();
        if !is_sound {
            self.broken.insert(index, bounds);
        }
        if !is_sound || !(member.casts || member.receives) {
            member.bounds = Aabb::EMPTY;
        }
        self.write(index, member, &record.facts);
    }

    /// Makes the entry at `index` one of no caster.
    pub(crate) fn clear(&mut self, index: u32) {
        self.broken.remove(&index);
        self.write(index, CasterBox::NOTHING, &CasterFacts::NOTHING);
    }

    /// Removes all entries from `count` on.
    pub(crate) fn truncate(&mut self, count: usize) {
        if count < self.len() {
            self.boxes.truncate(count);
            let gone = self.facts.drain(count..);
            self.always_changing -= gone.filter(|facts| facts.revision.is_none()).count();
            self.broken.split_off(&(count as u32));
            self.log.add_unknown();
        }
    }

    /// Makes the tree anew from all entries.
    pub(crate) fn rebuild_tree(&mut self) {
        if let Some(tree) = &mut self.tree {
            tree.rebuild(self.boxes.iter().map(|member| member.bounds));
        }
    }

    fn write(&mut self, index: u32, member: CasterBox, facts: &CasterFacts) {
        let at = index as usize;
        self.always_changing += usize::from(facts.revision.is_none());
        let (Some(held), Some(held_facts)) = (self.boxes.get_mut(at), self.facts.get_mut(at))
        else {
            self.boxes.push(member);
            self.facts.push(*facts);
            self.follow(index, &Aabb::EMPTY, &member.bounds);
            return;
        };
        self.always_changing -= usize::from(held_facts.revision.is_none());
        if *held != member || held_facts != facts {
            let before = std::mem::replace(held, member).bounds;
            *held_facts = *facts;
            self.follow(index, &before, &member.bounds);
        }
    }

    fn follow(&mut self, index: u32, before: &Aabb, bounds: &Aabb) {
        self.log.add(index, before, bounds);
        if let Some(tree) = &mut self.tree {
            tree.set(index, before, bounds);
        }
    }
}
