//! Defines a set of casters that stay from frame to frame.

use std::sync::atomic::{AtomicU64, Ordering};

use crate::ShadowError;
use crate::cast::ShadowCaster;
use crate::cast::caster_records::{CasterRecord, CasterRecords};

/// Selects the casters of a frame.
#[derive(Clone, Copy)]
#[non_exhaustive]
pub enum Casters<'c> {
    /// Takes a list. The methods of all of its casters are called in every frame, and each light
    /// tests all of their bounds. It suits scenes of up to some hundred casters, and tools.
    List(&'c [&'c dyn ShadowCaster]),
    /// Takes a [`CasterSet`]. A frame costs what has changed in the set and what is seen of it.
    Set(&'c dyn RetainedCasters),
}

impl<'c> From<&'c [&'c dyn ShadowCaster]> for Casters<'c> {
    fn from(list: &'c [&'c dyn ShadowCaster]) -> Self {
        Self::List(list)
    }
}

impl<'c> From<&'c Vec<&'c dyn ShadowCaster>> for Casters<'c> {
    fn from(list: &'c Vec<&'c dyn ShadowCaster>) -> Self {
        Self::List(list)
    }
}

impl<'c, const N: usize> From<&'c [&'c dyn ShadowCaster; N]> for Casters<'c> {
    fn from(list: &'c [&'c dyn ShadowCaster; N]) -> Self {
        Self::List(list)
    }
}

impl<'c, C: ShadowCaster> From<&'c CasterSet<C>> for Casters<'c> {
    fn from(set: &'c CasterSet<C>) -> Self {
        Self::Set(set)
    }
}

/// Is implemented by [`CasterSet`], whatever the type of its casters, and by no other type.
pub trait RetainedCasters: sealed::Retained {}

mod sealed {
    use crate::cast::ShadowCaster;
    use crate::cast::caster_records::{CasterRecords, CastersVersion};

    /// Is what a frame needs of a set.
    #[expect(
        private_interfaces,
        reason = "the trait cannot be named outside the crate"
    )]
    pub trait Retained {
        fn records(&self) -> &CasterRecords;
        /// Returns the number of the state of a frame that begins.
        fn version_of_frame(&self) -> CastersVersion;
        fn caster(&self, index: u32) -> &dyn ShadowCaster;
        /// Returns the number of casters, where instances count one by one.
        fn count(&self) -> usize;
    }
}

/// Identifies a caster of a [`CasterSet`]. No other caster of the process ever has the same id,
/// even where it takes the place of one that was removed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct CasterId {
    index: u32,
    ticket: u64,
}

impl CasterId {
    /// Returns the index by which errors and reports name the caster. Another caster may have it
    /// once this one is removed.
    pub const fn index(&self) -> u32 {
        self.index
    }
}

/// Holds casters from frame to frame, so that a frame costs what has changed and what is seen, and
/// not what there is.
///
/// The methods of a caster, but for [`pipeline`](ShadowCaster::pipeline) and
/// [`draw`](ShadowCaster::draw), are called where it is inserted or updated, and not in each frame.
/// What they return must stay true until then: a caster that moves without an
/// [`update`](Self::update) keeps its old shadow, or loses it. Maps are the same, bit for bit, as
/// with a list of the same casters.
///
/// Bounds are in render space. An engine that moves its `origin` updates all casters by what it
/// moves, since all of their bounds change.
///
/// `C` may be a type of the engine, or `Box<dyn ShadowCaster>` or `Arc<dyn ShadowCaster>` where
/// there are several types.
///
/// ```
/// use wgpu_shadows::{CasterSet, Casters, MeshCaster, ShadowError};
///
/// fn walk(set: &mut CasterSet<MeshCaster>, hero: MeshCaster) -> Result<(), ShadowError> {
///     let hero = set.insert(hero);
///     set.update(hero, |mesh| mesh.set_transform(wgpu_shadows::glam::Mat4::IDENTITY))?;
///     let casters = Casters::Set(set); // of a ShadowFrameDescriptor
///     # let _ = casters;
///     Ok(())
/// }
/// ```
#[derive(Debug)]
pub struct CasterSet<C> {
    slots: Vec<Option<Member<C>>>,
    /// Holds the indices of the slots that are empty.
    free: Vec<u32>,
    /// Has one entry for each caster that draws itself, and for each instance of all others.
    records: CasterRecords,
    /// Holds the indices of the entries that are not in use.
    free_entries: Vec<u32>,
    /// Distinguishes the frames of a set in which some caster may always look different.
    frames: AtomicU64,
}

#[derive(Debug)]
struct Member<C> {
    caster: C,
    ticket: u64,
    entries: Entries,
}

/// Holds the indices of the records of a caster. Most casters have one, which takes no memory of
/// its own.
#[derive(Debug, Default)]
struct Entries {
    first: Option<u32>,
    others: Vec<u32>,
}

impl Entries {
    fn get(&self, number: usize) -> Option<u32> {
        match number.checked_sub(1) {
            None => self.first,
            Some(number) => self.others.get(number).copied(),
        }
    }

    fn push(&mut self, entry: u32) {
        match self.first {
            None => self.first = Some(entry),
            Some(_) => self.others.push(entry),
        }
    }

    fn pop(&mut self) -> Option<u32> {
        self.others.pop().or_else(|| self.first.take())
    }

    fn len(&self) -> usize {
        usize::from(self.first.is_some()) + self.others.len()
    }
}

static NEXT_TICKET: AtomicU64 = AtomicU64::new(0);

impl<C> Default for CasterSet<C> {
    fn default() -> Self {
        Self {
            slots: Vec::new(),
            free: Vec::new(),
            records: CasterRecords::new(true),
            free_entries: Vec::new(),
            frames: AtomicU64::new(0),
        }
    }
}

impl<C: ShadowCaster> CasterSet<C> {
    /// Makes an empty set.
    pub fn new() -> Self {
        Self::default()
    }

    /// Adds a caster. Bounds that are neither finite nor empty are no error: the caster is left out
    /// of frames, which name it, until an update makes them valid.
    ///
    /// Many casters at once are added faster, and found faster later, by
    /// [`insert_all`](Self::insert_all).
    pub fn insert(&mut self, caster: C) -> CasterId {
        let id = self.place(caster);
        self.read(id.index);
        id
    }

    /// Adds casters and returns their ids in the same order. All casters of the set are then sorted
    /// anew, so that a level is loaded in one call rather than in many.
    pub fn insert_all(&mut self, casters: impl IntoIterator<Item = C>) -> Vec<CasterId> {
        let tree = self.records.tree.take();
        let add = |caster| self.insert(caster);
        let ids = casters.into_iter().map(add).collect();
        self.records.tree = tree;
        self.records.rebuild_tree();
        ids
    }

    /// Lets `change` change a caster, and calls its methods again. A caster that changes by itself,
    /// as one behind an `Arc` may, is updated with a `change` that does nothing.
    ///
    /// # Errors
    /// Returns [`ShadowError::UnknownCaster`] for a caster of another set or one that was removed.
    pub fn update<R>(
        &mut self,
        id: CasterId,
        change: impl FnOnce(&mut C) -> R,
    ) -> Result<R, ShadowError> {
        let member = self.slots.get_mut(id.index as usize);
        let member = member.and_then(Option::as_mut);
        let Some(member) = member.filter(|member| member.ticket == id.ticket) else {
            return Err(unknown(id));
        };
        let result = change(&mut member.caster);
        self.read(id.index);
        Ok(result)
    }

    /// Removes a caster and returns it.
    ///
    /// # Errors
    /// Returns [`ShadowError::UnknownCaster`] for a caster of another set or one that was removed.
    pub fn remove(&mut self, id: CasterId) -> Result<C, ShadowError> {
        let slot = self.slots.get_mut(id.index as usize);
        let taken = slot.and_then(|slot| slot.take_if(|member| member.ticket == id.ticket));
        let Some(mut member) = taken else {
            return Err(unknown(id));
        };
        while let Some(entry) = member.entries.pop() {
            self.records.clear(entry);
            self.free_entries.push(entry);
        }
        self.free.push(id.index);
        Ok(member.caster)
    }

    /// Returns a caster, or `None` for one of another set or one that was removed.
    pub fn get(&self, id: CasterId) -> Option<&C> {
        let member = self.slots.get(id.index as usize)?.as_ref()?;
        (member.ticket == id.ticket).then_some(&member.caster)
    }

    /// Returns all casters with their ids, in no order that means anything.
    pub fn iter(&self) -> impl Iterator<Item = (CasterId, &C)> {
        (0u32..).zip(&self.slots).filter_map(|(index, slot)| {
            let member = slot.as_ref()?;
            let ticket = member.ticket;
            Some((CasterId { index, ticket }, &member.caster))
        })
    }

    /// Returns the number of casters.
    pub fn len(&self) -> usize {
        self.slots.len() - self.free.len()
    }

    /// Returns whether there is no caster.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Calls the methods of the caster in a slot and keeps what they return.
    fn read(&mut self, index: u32) {
        let Some(Member {
            caster, entries, ..
        }) = &mut self.slots[index as usize]
        else {
            return;
        };
        let (records, free) = (&mut self.records, &mut self.free_entries);
        let mut count = 0;
        CasterRecord::each(caster, index, |record| {
            let entry = entries.get(count).unwrap_or_else(|| {
                let entry = free.pop().unwrap_or(records.len() as u32);
                entries.push(entry);
                entry
            });
            records.put(entry, &record);
            count += 1;
        });
        while entries.len() > count {
            let Some(entry) = entries.pop() else {
                break;
            };
            records.clear(entry);
            free.push(entry);
        }
    }

    /// Puts a caster into an empty slot.
    fn place(&mut self, caster: C) -> CasterId {
        let ticket = NEXT_TICKET.fetch_add(1, Ordering::Relaxed);
        let member = Some(Member {
            caster,
            ticket,
            entries: Entries::default(),
        });
        let index = match self.free.pop() {
            Some(index) => {
                self.slots[index as usize] = member;
                index
            }
            None => {
                self.slots.push(member);
                self.slots.len() as u32 - 1
            }
        };
        CasterId { index, ticket }
    }
}

fn unknown(id: CasterId) -> ShadowError {
    ShadowError::UnknownCaster {
        field: "id",
        index: id.index,
    }
}

impl<C: ShadowCaster> RetainedCasters for CasterSet<C> {}

#[expect(
    private_interfaces,
    reason = "the trait cannot be named outside the crate"
)]
impl<C: ShadowCaster> sealed::Retained for CasterSet<C> {
    fn records(&self) -> &CasterRecords {
        &self.records
    }

    fn version_of_frame(&self) -> super::caster_records::CastersVersion {
        let version = self.records.version();
        if self.records.always_changing == 0 {
            return version;
        }
        version.in_frame(self.frames.fetch_add(1, Ordering::Relaxed))
    }

    fn caster(&self, index: u32) -> &dyn ShadowCaster {
        let member = self.slots[index as usize].as_ref();
        &member.expect("a caster with bounds is in the set").caster
    }

    fn count(&self) -> usize {
        self.records.len() - self.free_entries.len()
    }
}
