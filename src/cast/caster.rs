//! What an engine implements for each thing that casts.

use crate::cast::CasterPipeline;
use crate::{Aabb, ShadowView};

/// Identity and version of what a caster would draw, by which a map is kept while nothing in it changes.
///
/// Two frames in which a view's casters have equal revisions, in equal order, under an unchanged fit, share one depth render.
/// Whatever changes a pixel of the depth map must change the version: vertices, world transform, bones, alpha texture,
/// pipeline. What only moves with the engine's `origin` need not. A version that stands still while the geometry moves leaves
/// a stale shadow behind.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Revision(Option<(Origin, u64, u64)>);

/// Whose ids a revision counts by.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
enum Origin {
    Engine,
    /// [`MeshCaster`](crate::MeshCaster)s number themselves.
    Mesh,
}

impl Revision {
    /// Never equal to what was drawn before: the view is rendered every frame. The safe default.
    pub const ALWAYS_CHANGING: Self = Self(None);

    /// `id` tells this caster from all others of the light; `version` counts its changes. No [`MeshCaster`](crate::MeshCaster)
    /// has the revision of an engine's own caster, whatever the ids.
    pub const fn new(id: u64, version: u64) -> Self {
        Self(Some((Origin::Engine, id, version)))
    }

    /// Returns the revision of a [`MeshCaster`](crate::MeshCaster).
    pub(crate) const fn of_mesh(id: u64, version: u64) -> Self {
        Self(Some((Origin::Mesh, id, version)))
    }

    /// May a map drawn under this revision be kept?
    pub(crate) const fn is_stable(&self) -> bool {
        self.0.is_some()
    }
}

/// Something that casts shadows.
///
/// [`ShadowScene::frame`](crate::ShadowScene::frame) calls every method but [`pipeline`](ShadowCaster::pipeline) and
/// [`draw`](ShadowCaster::draw) once, for all lights of the frame. Those two are called for each pass that the caster takes part
/// in.
pub trait ShadowCaster {
    /// Bounds in render space of everything that [`ShadowCaster::draw`] may draw, displacement included. Used to fit and to
    /// cull. Geometry outside its bounds loses its shadow at times; empty bounds cast nothing.
    fn bounds(&self) -> Aabb;

    /// How its vertices are laid out and shaded: a handle made once at load time.
    fn pipeline(&self) -> &CasterPipeline;

    /// Sets vertex and index buffers and draws. Pipeline and bind group 0 are set already; groups 1 and up are the caster's.
    /// `view` is the depth render being recorded, for engines that choose a level of detail by texel size; where
    /// six faces are drawn at once, it is one of them.
    ///
    /// What else it changes of the pass (viewport, scissor rectangle, pipeline, bind group 0) is restored before the next
    /// caster. It must close the debug groups that it opens, and its commands must be valid: wgpu tells of one that is not only
    /// when the encoder is finished, and the encoder is then lost with all passes in it. Call the light's `invalidate` in that
    /// case, since the light counts its maps as drawn.
    ///
    /// A panic in here leaves the layer that was being drawn without its shadows until the next frame, which draws it anew.
    fn draw(&self, pass: &mut wgpu::RenderPass<'_>, view: &ShadowView);

    /// Returns whether it casts shadows. The default returns true. One that does not is never drawn, but still receives: a
    /// window pane, a ground that nothing lies under.
    fn casts(&self) -> bool {
        true
    }

    /// Returns whether shadows on it are looked up. The default returns true. Where it returns false, no texels are spent on
    /// its surface: a sky dome, a helper without a surface of its own, an occluder that stands in for others.
    fn receives(&self) -> bool {
        true
    }

    /// Returns whether [`ShadowCaster::draw`] sets nothing of the pass but vertex and index buffers and bind groups 1 and up.
    /// Nothing then needs to be restored before the next caster, which saves four calls. The default returns false, which is
    /// always right. A caster that returns true and yet sets a viewport or scissor rectangle cuts off the shadows of the
    /// casters after it.
    fn keeps_pass_state(&self) -> bool {
        false
    }

    /// Returns whether [`ShadowCaster::draw`] makes the same calls whatever `view` it is given: a point light may then draw it
    /// into all six faces at once ([`OmniShadow`](crate::OmniShadow) tells when). The default returns false, which always gives
    /// a right picture. A caster that chooses by `view` and yet returns true is drawn as it chose for one of the faces.
    fn same_in_every_view(&self) -> bool {
        false
    }

    /// Triangles that [`ShadowCaster::draw`] draws into one view: for the report's counts, and to choose the cheaper way to
    /// draw; no picture depends on it. Zero where they are not known.
    fn triangles(&self) -> u32 {
        0
    }

    /// Identity and version of what would be drawn. The default says "always changing", so that a kept map is never stale.
    fn revision(&self) -> Revision {
        Revision::ALWAYS_CHANGING
    }
}
