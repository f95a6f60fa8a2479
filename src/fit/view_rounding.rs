//! States how far rounding may take depths and positions of a view, and which depths may be kept
//! for it.

use crate::fit::view::ShadowView;
use crate::fit::view_placement::ViewPlacement;

impl ShadowView {
    /// Returns the largest render coordinate, in world units, whose rounding all positions inside
    /// the view may have.
    pub(crate) const fn render_reach(&self) -> f64 {
        self.render_reach
    }

    /// Returns the same view over depths that were computed from render coordinates up to
    /// `render_reach`, perhaps under another origin: whatever is compared with them must allow for
    /// their rounding as well.
    pub(crate) const fn over_depths_from(mut self, render_reach: f64) -> Self {
        self.render_reach = self.render_reach.max(render_reach);
        self
    }

    /// Returns whether depths of this view that were computed from render coordinates up to
    /// `render_reach` are as good as new ones: their rounding is at most twice that of new ones, or
    /// at most [`KEPT_ROUNDING_TEXELS`]. So a map is kept while the origin moves with a camera, and
    /// drawn again, finer, before the rounding of distant coordinates becomes visible.
    pub(crate) fn may_keep_depths_from(&self, render_reach: f64) -> bool {
        let finest_texel_world = match &self.placement {
            ViewPlacement::Orthographic { bounds, .. } => bounds.rect.texel.min_element(),
            ViewPlacement::Perspective { rect, near, .. } => rect.texel.min_element() * near,
        };
        let rounding_world = position_error_world(render_reach);
        rounding_world <= 2.0 * self.position_error_world()
            || rounding_world <= KEPT_ROUNDING_TEXELS * finest_texel_world
    }

    /// Returns the rounding error of a depth comparison as ndc depth, absolute and relative to the
    /// depth: one ulp (2u) for storing and comparing and `4u` for the transform. Orthographic
    /// depths err relative to their range; perspective ones relative to themselves, but for the
    /// rasteriser's interpolation, which errs by the largest depth of a triangle.
    ///
    /// Where the device clips depth to -1..1, clip depth is 2 near - w. That is rounded by `u` of w
    /// at a triangle's far corner, and by as much again where the triangle is clipped at the sides
    /// of the map. At distance w' it comes to (2u w / w') / 2 of ndc depth, which is u w / near of
    /// near / w'.
    pub(crate) fn depth_error_ndc(&self) -> (f64, f64) {
        match &self.placement {
            ViewPlacement::Orthographic { .. } => (6.0 * UNIT_ROUNDOFF, 0.0),
            ViewPlacement::Perspective { near, .. } => {
                let clipping = if self.has_symmetric_clip_depth {
                    UNIT_ROUNDOFF * self.caster_reach / near
                } else {
                    0.0
                };
                (2.0 * UNIT_ROUNDOFF, 6.0 * UNIT_ROUNDOFF + clipping)
            }
        }
    }

    /// Returns the worst rounding error of a depth comparison in world units: what
    /// [`ShadowView::depth_error_ndc`] comes to.
    pub(crate) fn depth_error_world(&self) -> f64 {
        let (absolute, relative) = self.depth_error_ndc();
        match &self.placement {
            ViewPlacement::Orthographic { bounds, .. } => absolute * bounds.depth.length(),
            // Since depth = near / w, a depth error e is w² / near · e of distance.
            ViewPlacement::Perspective { near, .. } => {
                self.reach * self.reach / near * absolute + self.reach * relative
            }
        }
    }

    /// Returns the rounding error of the render coordinates that casters and receivers start from,
    /// in world units: `4u` of the largest. Those around a local light add `4u` of their distance
    /// from it; here that distance is left out, since the shader adds it for each receiver by
    /// itself.
    pub(crate) fn position_error_world(&self) -> f64 {
        position_error_world(self.render_reach)
    }

    /// Returns the same at the end of a local light's reach, where it is largest.
    pub(crate) fn largest_position_error_world(&self) -> f64 {
        position_error_world(self.render_reach + self.depth_range_from_light())
    }

    /// Returns the rounding error of a lookup's arithmetic across the map, in texels: `6uN`.
    pub(crate) fn lateral_error_texels(&self) -> f64 {
        6.0 * UNIT_ROUNDOFF * f64::from(self.map_size)
    }
}

/// Is the rounding, in texels, that kept depths may have whatever new ones would have: the offset
/// along the normal that allows for it is then far below the residual offset of a tenth of a texel.
const KEPT_ROUNDING_TEXELS: f64 = 1.0 / 64.0;

/// Returns the rounding error in world units of coordinates up to `render_reach`: `4u` of it.
pub(crate) fn position_error_world(render_reach: f64) -> f64 {
    4.0 * UNIT_ROUNDOFF * render_reach
}

/// Is u of f32: half an ulp of one.
pub(super) const UNIT_ROUNDOFF: f64 = f32::EPSILON as f64 * 0.5;
