//! Reports the cost of a frame's shadows and the resolution of their maps.

use glam::Vec2;

use crate::cast::{FrameCasters, Plan, ViewDraws};
use crate::report::{BrokenBounds, SliceReport, TexelRect};

/// Tells how a view was brought up to date in a frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum ViewStatus {
    /// The casters of the view were drawn.
    Drawn,
    /// Nothing in the view had changed, and its map was kept.
    Kept,
    /// The view needed drawing, but the frame's budget did not suffice: it keeps its last map, or
    /// is lit if it has none.
    Deferred,
    /// Nothing casts onto any receiver that the view covers: it has no map, and its receivers are
    /// lit.
    Empty,
}

/// Reports on one view of a light in one frame.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct ViewReport {
    /// Is the layer of the depth texture that the view is rendered into.
    pub layer: u32,
    /// Is the rectangle of the layer that the view is rendered into; empty for a view without a
    /// map.
    pub texels: TexelRect,
    /// Tells how the view was brought up to date.
    pub status: ViewStatus,
    /// Counts the casters in the view, each copy of a mesh as one: those that its pass drew, if it
    /// had one, and those that were copied. Where all faces of a point light were drawn in one
    /// pass, it counts all casters of that pass.
    pub casters: u32,
    /// Counts those of the casters that were not drawn: they had not changed for some frames, and
    /// the static-caster cache, which contains them, was copied into the layer before the other
    /// casters were drawn.
    pub copied: u32,
    /// Counts the draw calls of its passes: one for each caster that draws itself, and one for all
    /// copies of a mesh ([`ShadowCaster::instances`](crate::ShadowCaster::instances)). It is zero
    /// for a view that was not drawn. Where all faces of a point light were drawn in one pass, each
    /// face counts all calls of that pass.
    pub draws: u32,
    /// Counts the triangles of the casters that were not copied, as far as the casters report them
    /// ([`ShadowCaster::triangles`](crate::ShadowCaster::triangles)).
    pub triangles: u64,
    /// Counts the casters, each copy of a mesh as one, that were culled because their shadows
    /// cannot fall on what the view covers.
    pub culled: u32,
    /// Is the world size of a texel along the map's x and y. For a local light it is that at the
    /// farthest receiver that is seen within its range, where it is largest. It is zero for a view
    /// without a map.
    pub texel_size_world: Vec2,
    /// Is the world distance from the near plane to the far plane, or for a local light to the
    /// farthest receiver that is seen within its range, rounded up by at most 1.19. It is zero for
    /// a view without a map.
    pub depth_range_world: f32,
    /// Is the height in world units above which a caster that lies on a surface always casts its
    /// full shadow onto it: the largest gap (peter-panning) that the light's bias can leave, at the
    /// worst angle of the light.
    pub max_peter_panning_world: f32,
    /// Describes the slice of a camera's view that a cascade covers, and how much of the map falls
    /// on it. It is `None` for all other views.
    pub slice: Option<SliceReport>,
}

impl ViewReport {
    /// Describes a view with a map, apart from its slice, its peter-panning and what it culled.
    pub(crate) fn of(draws: &ViewDraws, casters: &FrameCasters<'_>) -> Self {
        let triangles: u64 = draws
            .casters
            .iter()
            .map(|&index| u64::from(casters.facts(index).triangles))
            .sum();
        Self {
            triangles: triangles.saturating_sub(draws.copied_triangles),
            layer: draws.view.layer(),
            texels: draws.view.texels(),
            status: match draws {
                ViewDraws { deferred: true, .. } => ViewStatus::Deferred,
                ViewDraws {
                    plan: Plan::Keep, ..
                } => ViewStatus::Kept,
                _ => ViewStatus::Drawn,
            },
            casters: draws.casters.len() as u32,
            copied: draws.copied,
            draws: draws.draw_calls(),
            culled: 0,
            texel_size_world: draws.view.texel_size_world(),
            depth_range_world: draws.view.depth_range_world(),
            max_peter_panning_world: 0.0,
            slice: None,
        }
    }

    /// Returns the report of a view into which nothing casts, apart from what it culled.
    pub(crate) fn empty(layer: u32) -> Self {
        Self {
            layer,
            texels: TexelRect::default(),
            status: ViewStatus::Empty,
            casters: 0,
            copied: 0,
            draws: 0,
            triangles: 0,
            culled: 0,
            texel_size_world: Vec2::ZERO,
            depth_range_world: 0.0,
            max_peter_panning_world: 0.0,
            slice: None,
        }
    }
}

/// Reports what a light did in a frame.
#[derive(Clone, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct ShadowReport {
    /// Has one entry per view, in the order of the frame's lights and of the layers of each.
    pub views: Vec<ViewReport>,
    /// Lists the bounds of casters and receivers that have a NaN or an infinite corner. Their
    /// objects are left out of the frame: such a caster has no shadow.
    pub broken_bounds: Vec<BrokenBounds>,
    /// Counts the depth passes that were recorded: one per drawn view, and two where the
    /// static-caster cache was drawn first. A single one draws all views that share a layer: the
    /// cascades of a layout that is found, and the views of a pool. A single one draws all faces of
    /// a point light where that is cheaper ([`OmniShadow`](crate::OmniShadow) states when).
    pub passes: u32,
    pub(crate) draws: u32,
    /// Is the error that is predicted for the layout of a directional light under
    /// [`CascadeLayout::Automatic`](crate::CascadeLayout::Automatic), or for that of a pool: the
    /// root of the mean squared error of visibility over the pixels of the images, for images of
    /// 720 rows and the default filter; for a pool over all pairs of a pixel and a light that
    /// shines on it. It is estimated from bounds, so that it serves to compare layouts and scenes
    /// rather than as a promise. It is `None` for all other lights, and for a pool without a camera
    /// in the frame.
    pub predicted_error: Option<f32>,
    /// Is the device memory, in bytes, of the depth texture and of the static-caster caches.
    pub bytes_held: u64,
}

impl ShadowReport {
    /// Returns the number of draw calls. All copies of a mesh in a view take one. A caster that
    /// draws itself counts one for each view, or set of faces, that it is drawn into, however many calls it makes.
    pub fn draws(&self) -> u32 {
        self.draws
    }

    /// Returns the number of triangles drawn, summed over the views that were drawn, as far as the
    /// casters report them.
    pub fn triangles(&self) -> u64 {
        self.drawn()
            .map(|view| view.triangles)
            .fold(0, u64::saturating_add)
    }

    /// Returns the number of texels of the maps that were cleared and drawn again: those in the
    /// rectangles of the views that were drawn. Together with the triangles it tells, on any
    /// device, what the depth passes of a frame have to do. A static-caster cache that was drawn
    /// first adds as many again, and is not counted.
    pub fn texels(&self) -> u64 {
        self.drawn()
            .map(|view| view.texels.size.as_u64vec2().element_product())
            .fold(0, u64::saturating_add)
    }

    /// Takes note of what a frame consists of, whether or not it is drawn.
    pub(crate) fn note_frame(&mut self, casters: &FrameCasters<'_>) {
        for view in &mut self.views {
            view.culled = (casters.len() as u32).saturating_sub(view.casters);
        }
        self.broken_bounds.clear();
        self.broken_bounds.extend_from_slice(casters.broken);
    }

    fn drawn(&self) -> impl Iterator<Item = &ViewReport> {
        self.views
            .iter()
            .filter(|view| view.status == ViewStatus::Drawn)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn any_numbers_are_counted_without_a_panic() {
        let view = |draws| ViewReport {
            status: ViewStatus::Drawn,
            draws,
            triangles: u64::MAX,
            texels: TexelRect::whole(u32::MAX),
            ..ViewReport::empty(0)
        };
        let report = ShadowReport {
            views: vec![view(0), view(u32::MAX), view(7)],
            broken_bounds: Vec::new(),
            passes: 3,
            draws: 0,
            predicted_error: None,
            bytes_held: 0,
        };
        assert_eq!(report.triangles(), u64::MAX);
        assert_eq!(report.texels(), u64::MAX);
    }
}
