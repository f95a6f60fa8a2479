//! What a frame's shadows cost and how fine they are.

use glam::Vec2;

use crate::report::SliceReport;

/// What became of a view in a frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum ViewStatus {
    /// Its casters were drawn.
    Drawn,
    /// Nothing in it had changed; its map was kept.
    Kept,
    /// It needed drawing and the frame's budget did not reach it: it shows its last map.
    Deferred,
    /// Nothing casts onto anything that it sees; there is no map, and all is lit.
    Empty,
}

/// One view of a light in one frame.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct ViewReport {
    /// Layer of the depth texture.
    pub layer: u32,
    /// What became of it.
    pub status: ViewStatus,
    /// Casters in the view: the draws of its pass, where there was one, and what was copied. In one pass with
    /// other faces, all that it draws.
    pub casters: u32,
    /// Casters of these that were not drawn: they stood still for some frames, and the layer that is kept of them was copied
    /// under the others.
    pub copied: u32,
    /// Triangles of those casters that were not copied, as far as they tell ([`ShadowCaster::triangles`](crate::ShadowCaster::triangles)).
    pub triangles: u64,
    /// Casters left out because nothing of them can fall on what the view covers.
    pub culled: u32,
    /// World size of a texel along the map's x and y; for a local light that at the farthest receiver that is seen within its
    /// range, where it is largest.
    pub texel_size_world: Vec2,
    /// World distance from the near plane to the far plane, or for a local light to the farthest receiver that is seen within
    /// its range, rounded up by at most 1.19.
    pub depth_range_world: f32,
    /// Height in world units above which a caster that lies on a surface always casts onto it: the worst gap (peter-panning)
    /// that the light's bias can leave, at the worst angle.
    pub max_peter_panning_world: f32,
    /// For a cascade of a camera's view: its slice, and how much of the map falls on it.
    pub slice: Option<SliceReport>,
}

impl ViewReport {
    /// A view that nothing casts into.
    pub(crate) fn empty(layer: u32, culled: u32) -> Self {
        Self {
            layer,
            status: ViewStatus::Empty,
            casters: 0,
            copied: 0,
            triangles: 0,
            culled,
            texel_size_world: Vec2::ZERO,
            depth_range_world: 0.0,
            max_peter_panning_world: 0.0,
            slice: None,
        }
    }
}

/// What a light did in a frame.
#[derive(Clone, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct ShadowReport {
    /// One entry per view, in the order of the frame's lights and of the layers of each.
    pub views: Vec<ViewReport>,
    /// Depth passes recorded: one per drawn view, two where what stands still was drawn into a layer of its own first; a single
    /// one for all faces of a point light where that is cheaper ([`OmniShadow`](crate::OmniShadow) tells when).
    pub passes: u32,
    /// Device memory of the depth texture and of the layers that are kept of what stands still.
    pub bytes_held: u64,
}

impl ShadowReport {
    /// Casters drawn: once for each view that was drawn, or once in all where six faces were drawn in one pass.
    pub fn draws(&self) -> u32 {
        let draws = self
            .drawn()
            .map(|view| view.casters.saturating_sub(view.copied));
        if self.passes == 1 {
            draws.max().unwrap_or(0)
        } else {
            draws.fold(0, u32::saturating_add)
        }
    }

    /// Triangles drawn, summed over the views that were drawn, as far as casters tell.
    pub fn triangles(&self) -> u64 {
        self.drawn()
            .map(|view| view.triangles)
            .fold(0, u64::saturating_add)
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
        let view = |casters, copied| ViewReport {
            status: ViewStatus::Drawn,
            casters,
            copied,
            triangles: u64::MAX,
            ..ViewReport::empty(0, 0)
        };
        let report = ShadowReport {
            views: vec![view(0, 1), view(u32::MAX, 0), view(7, 2)],
            passes: 3,
            bytes_held: 0,
        };
        assert_eq!(report.draws(), u32::MAX);
        assert_eq!(report.triangles(), u64::MAX);
    }
}
