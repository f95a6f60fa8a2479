//! What a frame brings for all lights: origin, cameras, casters and receivers, checked and gathered once.

use glam::{DVec3, Vec3};

use crate::cast::{BrokenBounds, CasterAnswers, FrameCasters, ShadowCaster, sound_bounds};
use crate::check;
use crate::fit::{CameraFrustum, HalfSpaces, Region};
use crate::{Aabb, CameraView, ShadowError};

/// Which receivers the shadows of a frame are for: nothing else needs a map.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum Coverage<'a> {
    /// What any of these cameras sees: one for an ordinary frame, several for the eyes of a headset, a split screen or a mirror.
    /// All of them look up the same maps. Of no camera nothing is seen, and nothing is drawn.
    Cameras(&'a [CameraView]),
    /// What lies in a box of render space, as in the textbook. The window of a directional light is then this box, held by its
    /// first cascade alone, whatever the casters. Surfaces outside are lit.
    Bounds(Aabb),
    /// Everything that receives, wherever it is: for scenes that are small, or seen from everywhere.
    Everything,
}

/// What a frame brings. The casters are borrowed for as long as lights are recorded with the frame, the rest only while it is
/// made.
#[derive(Clone, Copy)]
pub struct ShadowFrameDescriptor<'d, 'c> {
    /// World position of render space's origin, f64. Zero unless the engine renders relative to its camera. Texels keep their
    /// places in the world, so f64 must tell them apart there: with texels of `t` units, in maps of 64 or more a side, a frame is
    /// accepted up to at least `2⁴⁷ t` units from the world's origin, 1.4·10¹² for a centimetre. Some hundred times as far it is
    /// [`ShadowError::ViewNotRepresentable`].
    pub origin: DVec3,
    /// Which receivers the shadows are for.
    pub coverage: Coverage<'d>,
    /// Everything that may cast. All of it receives as well, unless [`ShadowCaster::receives`] says otherwise.
    pub casters: &'c [&'c dyn ShadowCaster],
    /// Bounds in render space of surfaces that receive and do not cast.
    pub receivers: &'d [Aabb],
}

/// The scene that lights share. It keeps the memory of its lists from frame to frame.
#[derive(Debug, Default)]
pub struct ShadowScene {
    answers: CasterAnswers,
    broken: Vec<BrokenBounds>,
    receivers: Vec<Aabb>,
    receiver_casters: Vec<Option<u32>>,
    cameras: Vec<CameraFrustum>,
    seen: Vec<HalfSpaces>,
}

impl ShadowScene {
    /// Makes an empty scene.
    pub fn new() -> Self {
        Self::default()
    }

    /// Checks a frame and gathers the bounds of its casters, once for all lights that are recorded with it. Every caster is asked
    /// here what it is; while the lights are recorded it is only drawn.
    ///
    /// # Errors
    /// [`ShadowError`] for an origin, camera or covered box that is not finite or describes no volume. Bounds of casters and
    /// receivers that are not finite are no error: [`ShadowFrame::broken_bounds`] names them.
    pub fn frame<'a>(
        &'a mut self,
        descriptor: &ShadowFrameDescriptor<'_, 'a>,
    ) -> Result<ShadowFrame<'a>, ShadowError> {
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
        self.receiver_casters.clear();
        self.receiver_casters.resize(self.receivers.len(), None);
        let casters = self.answers.ask(
            "ShadowFrameDescriptor::casters",
            descriptor.casters,
            &mut self.broken,
            |caster, bounds| {
                self.receivers.push(bounds);
                self.receiver_casters.push(Some(caster));
            },
        );
        Ok(ShadowFrame {
            origin: descriptor.origin,
            region: match descriptor.coverage {
                Coverage::Cameras(_) => Region::Cameras(&self.cameras),
                Coverage::Bounds(bounds) => Region::Bounds(bounds),
                Coverage::Everything => Region::Everything,
            },
            seen: &self.seen,
            casters,
            receivers: &self.receivers,
            receiver_casters: &self.receiver_casters,
        })
    }
}

/// A frame of a [`ShadowScene`], checked: what the lights are recorded with.
#[derive(Clone, Copy)]
pub struct ShadowFrame<'a> {
    pub(crate) origin: DVec3,
    pub(crate) region: Region<'a>,
    /// The same region as half-spaces: receivers count where they lie in one of these.
    pub(crate) seen: &'a [HalfSpaces],
    pub(crate) casters: FrameCasters<'a>,
    /// Bounds of all that receives.
    pub(crate) receivers: &'a [Aabb],
    /// Holds, for each receiver, the index of the caster whose surface it is, if it is one's.
    pub(crate) receiver_casters: &'a [Option<u32>],
}

impl ShadowFrame<'_> {
    /// Returns the bounds that are infinite or not numbers. Casters and receivers with such bounds are left out of the
    /// frame, which is otherwise as it would be without them: in a running engine, one broken object must not take the
    /// shadows of all others. Each light's report names them as well.
    pub fn broken_bounds(&self) -> &[BrokenBounds] {
        self.casters.broken
    }

    /// Returns where the first camera stands, in render space.
    pub(crate) fn viewer_render(&self) -> Option<Vec3> {
        match self.region {
            Region::Cameras(cameras) => cameras.first().map(CameraFrustum::eye_render),
            Region::Bounds(_) | Region::Everything => None,
        }
    }
}
