//! Defines what an engine implements for each object that casts shadows.

use crate::cast::CasterPipeline;
use crate::fit::CasterShape;
use crate::{Aabb, ShadowView};

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
    /// Marks the ids that [`MeshCaster`](crate::MeshCaster)s assign to themselves.
    Mesh,
}

impl Revision {
    /// Makes a revision from an `id`, which distinguishes this caster from all others of the light,
    /// and a `version`, which counts its changes. Both may be any number. No
    /// [`MeshCaster`](crate::MeshCaster) has the revision of an engine's own caster, whatever the
    /// ids. Two casters that share an id and a version are taken for each other, and leave a stale
    /// shadow where one replaces the other.
    pub const fn new(id: u64, version: u64) -> Self {
        Self {
            origin: Origin::Engine,
            id,
            version,
        }
    }

    /// Returns the revision of a [`MeshCaster`](crate::MeshCaster).
    pub(crate) const fn of_mesh(id: u64, version: u64) -> Self {
        Self {
            origin: Origin::Mesh,
            id,
            version,
        }
    }
}

/// Draws an object that casts shadows into depth maps.
///
/// [`ShadowScene::frame`](crate::ShadowScene::frame) calls every method but
/// [`pipeline`](ShadowCaster::pipeline) and [`draw`](ShadowCaster::draw) once, for all lights of
/// the frame, unless the caster is in a [`CasterSet`](crate::CasterSet), which calls them when the
/// caster is inserted or updated. Those two are called for each pass that the caster takes part in.
pub trait ShadowCaster {
    /// Returns the bounds, in render space and world units, of everything that
    /// [`ShadowCaster::draw`] may draw, displacement included. The bounds are used to fit the maps
    /// and to cull. They must be finite or empty: a caster with other bounds is left out of the
    /// frame, and [`ShadowFrame::broken_bounds`](crate::ShadowFrame::broken_bounds) names it. Empty
    /// bounds cast nothing. Bounds that are too small lose the shadow of the geometry outside them
    /// at times; bounds that are too large cost resolution and draws.
    fn bounds(&self) -> Aabb;

    /// Returns the pipeline that defines how the caster's vertices are laid out and shaded. It is a
    /// handle that is made once, at load time. A pipeline of another device or without the map's
    /// depth format makes the light's `record` return
    /// [`ShadowError::CasterDevice`](crate::ShadowError::CasterDevice) or
    /// [`ShadowError::CasterFormat`](crate::ShadowError::CasterFormat).
    fn pipeline(&self) -> &CasterPipeline;

    /// Sets vertex and index buffers and draws. Pipeline and bind group 0 are set already; groups 1
    /// and up belong to the caster. `view` is the depth render being recorded, for engines that
    /// choose a level of detail by texel size; where six faces are drawn at once, it is one of
    /// them.
    ///
    /// Any other state of the pass that it changes (viewport, scissor rectangle, pipeline, bind
    /// group 0) is restored before the next caster, unless [`ShadowCaster::keeps_pass_state`]
    /// returns true. It must close the debug groups that it opens, and its commands must be valid:
    /// wgpu reports an invalid one only when the encoder is finished, and the encoder is then lost
    /// with all passes in it. Call the light's `invalidate` in that case, since the light counts
    /// its maps as drawn.
    ///
    /// A panic in this method leaves the layer that was being drawn without its shadows until the
    /// next frame, which draws it again.
    fn draw(&self, pass: &mut wgpu::RenderPass<'_>, view: &ShadowView);

    /// Returns whether the caster casts shadows. The default returns true. A caster that returns
    /// false is never drawn but may still receive: a window pane, for example, or a ground with
    /// nothing below it.
    fn casts(&self) -> bool {
        true
    }

    /// Returns whether shadows are looked up on the caster's surface. The default returns true.
    /// Where it returns false, no texels are spent on the surface: a sky dome, a helper without a
    /// surface of its own, an occluder that replaces other objects. If a surface on which shadows
    /// are looked up returns false, maps may leave it out, and it can be lit where it should be
    /// shadowed.
    fn receives(&self) -> bool {
        true
    }

    /// Returns what is known of the surface within the bounds. The default, [`CasterShape::Any`],
    /// is always correct. With [`CasterShape::Convex`] or [`CasterShape::Cuboid`] for a ground or a
    /// wall that is one, the map need not cover all of it ([`CasterShape`] states the symptom of a
    /// wrong value).
    fn shape(&self) -> CasterShape {
        CasterShape::Any
    }

    /// Returns whether [`ShadowCaster::draw`] sets no state of the pass but vertex and index
    /// buffers and bind groups 1 and up. Nothing then needs to be restored before the next caster,
    /// which saves four calls. The default returns false, which is always correct. A caster that
    /// returns true and yet sets a viewport or scissor rectangle cuts off the shadows of the
    /// casters after it.
    fn keeps_pass_state(&self) -> bool {
        false
    }

    /// Returns whether [`ShadowCaster::draw`] makes the same calls whatever `view` it is given: a
    /// point light may then draw it into all six faces at once ([`OmniShadow`](crate::OmniShadow)
    /// states the conditions). The default returns false, which always gives a correct image. A
    /// caster that chooses by `view` and yet returns true is drawn as it chose for one of the
    /// faces.
    fn same_in_every_view(&self) -> bool {
        false
    }

    /// Returns the number of triangles that [`ShadowCaster::draw`] draws into one view. It is used
    /// for the report's counts and to choose the cheaper way to draw; no image depends on it. The
    /// default returns 0, which means that the number is not known.
    fn triangles(&self) -> u32 {
        0
    }

    /// Returns the identity and version of what would be drawn, or `None` for a caster that may
    /// look different in every frame: a view with such a caster is rendered in every frame. The
    /// default returns `None`, which is always correct and never saves a pass.
    fn revision(&self) -> Option<Revision> {
        None
    }
}

/// Implements the trait for a pointer to a caster.
macro_rules! forward {
    ($pointer:ty) => {
        impl<C: ShadowCaster + ?Sized> ShadowCaster for $pointer {
            fn bounds(&self) -> Aabb {
                (**self).bounds()
            }

            fn pipeline(&self) -> &CasterPipeline {
                (**self).pipeline()
            }

            fn draw(&self, pass: &mut wgpu::RenderPass<'_>, view: &ShadowView) {
                (**self).draw(pass, view);
            }

            fn casts(&self) -> bool {
                (**self).casts()
            }

            fn receives(&self) -> bool {
                (**self).receives()
            }

            fn shape(&self) -> CasterShape {
                (**self).shape()
            }

            fn keeps_pass_state(&self) -> bool {
                (**self).keeps_pass_state()
            }

            fn same_in_every_view(&self) -> bool {
                (**self).same_in_every_view()
            }

            fn triangles(&self) -> u32 {
                (**self).triangles()
            }

            fn revision(&self) -> Option<Revision> {
                (**self).revision()
            }
        }
    };
}

forward!(&C);
forward!(Box<C>);
forward!(std::sync::Arc<C>);
forward!(std::rc::Rc<C>);
