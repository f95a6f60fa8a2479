//! Defines the input of a frame for all lights: origin, cameras, casters and receivers, which are
//! checked and collected once.

use std::sync::atomic::{AtomicU64, Ordering};

use glam::{DVec3, Vec3};

use crate::cast::{
    BrokenBounds, CasterRecords, Casters, CastersVersion, FrameCasters, sound_bounds,
};
use crate::check;
use crate::fit::{CameraFrustum, ChangedBoxes, HalfSpaces, Receivers, Region};
use crate::{Aabb, CameraView, ShadowError};

/// Selects the receivers for which the shadows of a frame are rendered. Maps cover no other
/// surfaces.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum Coverage<'a> {
    /// Covers what any of these cameras sees: one for an ordinary frame, several for the eyes of a
    /// headset, a split screen or a mirror. All of them sample the same maps. With an empty list
    /// nothing counts as seen, and nothing is drawn.
    ///
    /// The array must live until [`ShadowScene::frame`] returns. Where the descriptor is a variable
    /// of its own, the array needs a name as well (`let cameras = [camera];`, then
    /// `Coverage::Cameras(&cameras)`): otherwise compilers before Rust 1.89 report a temporary
    /// value that is dropped while borrowed (E0716).
    Cameras(&'a [CameraView]),
    /// Covers what lies in a box of render space, as textbook examples do. The box must be finite;
    /// an empty one covers nothing.
    ///
    /// The light-space bounds of a directional light then follow from this box, whatever the
    /// casters, and its first cascade alone covers it. Its shadows end at the sides of the smallest
    /// rectangle, along the axes of the map, that holds the box as seen from the light, or up to a
    /// texel beyond. So they end steadily wherever the box moves, but not at the box itself: a
    /// surface in front of the box or behind it, seen from the light, keeps its shadows. They end
    /// at once, because a [`fade`](crate::DirectionalShadowDescriptor::fade) needs a distance. (The
    /// lookup compares a position with the rectangle and with one plane. The six sides of the box
    /// would cost every lookup of every light, under cameras as well.) Shadows of spot and point
    /// lights end at their range.
    Bounds(Aabb),
    /// Covers all receivers, wherever they are: for scenes that are small or that are seen from
    /// everywhere.
    Everything,
}

/// Describes the input of a frame. The casters stay borrowed for as long as lights are recorded
/// with the frame, all other fields only until [`ShadowScene::frame`] returns.
#[derive(Clone, Copy)]
pub struct ShadowFrameDescriptor<'d, 'c> {
    /// Is the world position of the origin of render space (f64, finite). It is zero unless the
    /// engine renders relative to its camera. An origin that differs from the one the engine
    /// subtracts displaces all shadows.
    ///
    /// The texels of a directional light keep their positions in the world, so f64 must distinguish
    /// them there. A frame whose view extends over `e` units, in a map of `n` texels per side (64
    /// if it has fewer), is taken up to a distance of `2⁵⁰ e / n` units from the world origin,
    /// which is 5·10¹³ units for 100 units in 2048 texels. Beyond that the light's `record` returns
    /// [`ShadowError::ViewNotRepresentable`], whose docs tell more.
    pub origin: DVec3,
    /// Selects the receivers for which the shadows are rendered.
    pub coverage: Coverage<'d>,
    /// Holds all objects that may cast: a list, or a [`CasterSet`](crate::CasterSet) in scenes of
    /// many. All of them receive as well, unless
    /// [`ShadowCaster::receives`](crate::ShadowCaster::receives) returns false.
    pub casters: Casters<'c>,
    /// Lists the bounds, in render space, of the surfaces that receive and do not cast. Each must
    /// be finite or empty; others are left out of the frame and named by
    /// [`ShadowFrame::broken_bounds`]. A surface that is missing here may lie outside the maps, and
    /// is then lit.
    pub receivers: &'d [Aabb],
}

/// Identifies the input of a frame: two frames with equal versions are equal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct FrameVersion {
    casters: CastersVersion,
    /// Is unique in the process for all but the casters.
    surroundings: u64,
}

/// Is all that a frame is made of, apart from its casters and the list of its receivers.
#[derive(Clone, Debug, PartialEq)]
struct Surroundings {
    origin: DVec3,
    cameras: Vec<CameraView>,
    /// Is `None` where the coverage is a list of cameras, empty where it is everything.
    bounds: Option<Option<Aabb>>,
}

static NEXT_SURROUNDINGS: AtomicU64 = AtomicU64::new(0);

/// Holds the scene that lights share. It reuses the memory of its lists from frame to frame.
#[derive(Debug, Default)]
pub struct ShadowScene {
    records: CasterRecords,
    broken: Vec<BrokenBounds>,
    receivers: Vec<Aabb>,
    cameras: Vec<CameraFrustum>,
    seen: Vec<HalfSpaces>,
    /// Holds the surroundings of the last frame, with their number.
    surroundings: Option<(Surroundings, u64)>,
    /// Holds the receivers of the last frame as they were given.
    given_receivers: Vec<Aabb>,
}

impl ShadowScene {
    /// Makes an empty scene.
    pub fn new() -> Self {
        Self::default()
    }

    /// Checks a frame and collects the bounds of its casters, once for all lights that are recorded
    /// with it. The methods of every caster of a list but
    /// [`pipeline`](crate::ShadowCaster::pipeline) and [`draw`](crate::ShadowCaster::draw) are
    /// called here; while the lights are recorded, only these two and
    /// [`instances`](crate::ShadowCaster::instances) are called. Of a set, none is called here.
    ///
    /// # Errors
    /// Returns [`ShadowError`] for an origin that is not finite, for a camera whose matrices are
    /// not finite and invertible or whose distance limit is not above 0, and for a covered box that
    /// is neither finite nor empty. Bounds of casters and receivers that are not finite are no
    /// error: [`ShadowFrame::broken_bounds`] names them.
    pub fn frame<'a>(
        &'a mut self,
        descriptor: &ShadowFrameDescriptor<'_, 'a>,
    ) -> Result<ShadowFrame<'a>, ShadowError> {
        let surroundings = self.note_surroundings(descriptor);
        check::finite_vector("ShadowFrameDescriptor::origin", descriptor.origin)?;
        self.cameras.clear();
        self.seen.clear();
        match descriptor.coverage {
            Coverage::Everything => self.seen.push(HalfSpaces::default()),
            Coverage::Bounds(bounds) => {
                check::bounds("ShadowFrameDescriptor::coverage", &bounds)?;
                if !bounds.is_empty() {
                    self.seen.push(HalfSpaces::of_box(&bounds));
                }
            }
            Coverage::Cameras(cameras) => {
                for (index, camera) in cameras.iter().enumerate() {
                    let frustum = camera.frustum(index)?;
                    self.seen.push(frustum.planes);
                    self.cameras.push(frustum);
                }
            }
        }
        self.broken.clear();
        self.receivers.clear();
        let given = descriptor.receivers.iter().enumerate();
        self.receivers.extend(given.map(|(index, bounds)| {
            let place = ("ShadowFrameDescriptor::receivers", index);
            sound_bounds(place, *bounds, &mut self.broken)
        }));
        let casters = FrameCasters::new(
            "ShadowFrameDescriptor::casters",
            descriptor.casters,
            &mut self.records,
            &mut self.broken,
        );
        Ok(ShadowFrame {
            version: FrameVersion {
                casters: casters.version(),
                surroundings,
            },
            origin: descriptor.origin,
            region: match descriptor.coverage {
                Coverage::Cameras(_) => Region::Cameras(&self.cameras),
                Coverage::Bounds(bounds) => Region::Bounds(bounds),
                Coverage::Everything => Region::Everything,
            },
            seen: &self.seen,
            casters,
            receivers: Receivers {
                given: &self.receivers,
                casters: casters.receiving(),
            },
        })
    }

    /// Returns the number of the surroundings of a frame, a new one unless they are those of the
    /// last frame.
    fn note_surroundings(&mut self, descriptor: &ShadowFrameDescriptor<'_, '_>) -> u64 {
        let (cameras, bounds) = match descriptor.coverage {
            Coverage::Cameras(cameras) => (cameras, None),
            Coverage::Bounds(bounds) => (&[][..], Some(Some(bounds))),
            Coverage::Everything => (&[][..], Some(None)),
        };
        if let Some((last, number)) = &self.surroundings {
            if last.origin == descriptor.origin
                && last.cameras == cameras
                && last.bounds == bounds
                && self.given_receivers == descriptor.receivers
            {
                return *number;
            }
        }
        let number = NEXT_SURROUNDINGS.fetch_add(1, Ordering::Relaxed);
        self.given_receivers.clear();
        self.given_receivers.extend_from_slice(descriptor.receivers);
        let mut list = self.surroundings.take().map(|(last, _)| last.cameras);
        let list = list.get_or_insert_default();
        list.clear();
        list.extend_from_slice(cameras);
        let surroundings = Surroundings {
            origin: descriptor.origin,
            cameras: std::mem::take(list),
            bounds,
        };
        self.surroundings = Some((surroundings, number));
        number
    }
}

/// Holds a checked frame of a [`ShadowScene`]. Lights are recorded with it.
#[derive(Clone, Copy)]
pub struct ShadowFrame<'a> {
    pub(crate) version: FrameVersion,
    pub(crate) origin: DVec3,
    pub(crate) region: Region<'a>,
    /// Holds the same region as intersections of half-spaces: receivers count where they lie in one
    /// of these.
    pub(crate) seen: &'a [HalfSpaces],
    pub(crate) casters: FrameCasters<'a>,
    pub(crate) receivers: Receivers<'a>,
}

impl<'a> ShadowFrame<'a> {
    /// Returns the bounds of casters and receivers that have a NaN or an infinite corner and are
    /// not empty. Their objects are left out of the frame, and all others keep their shadows. Each
    /// light's report lists the same bounds
    /// ([`ShadowReport::broken_bounds`](crate::report::ShadowReport::broken_bounds)).
    pub fn broken_bounds(&self) -> &[BrokenBounds] {
        self.casters.broken
    }

    /// Returns the casters and receivers that have changed since an earlier frame, or `None` where
    /// anything else may have changed as well.
    pub(crate) fn changes_since(&self, version: &FrameVersion) -> Option<ChangedBoxes<'a>> {
        let same_surroundings = version.surroundings == self.version.surroundings;
        let changes = || self.casters.changes_since(&version.casters);
        same_surroundings.then(changes).flatten()
    }

    /// Returns the position of the first camera in render space, or `None` where the frame has no
    /// camera.
    pub(crate) fn camera_render(&self) -> Option<Vec3> {
        match self.region {
            Region::Cameras(cameras) => cameras.first().map(|camera| camera.eye().as_vec3()),
            Region::Bounds(_) | Region::Everything => None,
        }
    }
}
