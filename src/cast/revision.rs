//! Defines the identity and version of what a caster draws.

use std::sync::atomic::{AtomicU64, Ordering};

/// Identifies what a caster would draw and counts its versions, so that a map is kept while nothing
/// in it changes.
///
/// Two frames share one depth render of a view if the view's casters have equal revisions, in
/// whatever order, and its fit is unchanged. Whatever changes a pixel of the depth map must change
/// the version: vertices, world transform, bones, alpha texture, pipeline. A move of the engine's
/// `origin` alone needs no new version. A version that stays the same while the geometry changes
/// leaves a stale shadow behind; a version that changes without need costs a depth pass.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Revision {
    origin: Origin,
    id: u64,
    version: u64,
}

/// Tells who assigned the id of a revision, so that ids of different sources never collide.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
enum Origin {
    Engine,
    /// Marks the ids that ready-made meshes and their instances assign to themselves.
    Mesh,
}

impl Revision {
    /// Makes a revision from an `id`, which distinguishes this caster from all others of the light,
    /// and a `version`, which counts its changes. Both may be any number. No ready-made mesh has
    /// the revision of an engine's own caster, whatever the ids. Two casters that share an id and a
    /// version are taken for each other, and leave a stale shadow where one replaces the other.
    pub const fn new(id: u64, version: u64) -> Self {
        Self {
            origin: Origin::Engine,
            id,
            version,
        }
    }

    /// Returns the first revision of a ready-made mesh or of an instance, with an id of its own.
    pub(crate) fn of_new_mesh() -> Self {
        static NEXT_ID: AtomicU64 = AtomicU64::new(0);
        Self {
            origin: Origin::Mesh,
            id: NEXT_ID.fetch_add(1, Ordering::Relaxed),
            version: 0,
        }
    }

    /// Returns the next version of the same.
    pub(crate) const fn next(self) -> Self {
        Self {
            version: self.version.wrapping_add(1),
            ..self
        }
    }
}
