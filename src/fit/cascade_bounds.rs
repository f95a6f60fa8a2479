//! Fits the light-space bounds of one cascade of a directional light.

use glam::{DVec3, UVec2};

use crate::fit::axes::LightBox;
use crate::fit::caster_parts::CasterPart;
use crate::fit::directional_input::{CasterBounds, FitInput, FitLimits, Region};
use crate::fit::extruded_rect::push_extruded_rect;
use crate::fit::map_rect::{HeldBounds, HeldDepth, HeldRect, LightSpaceBounds, MapRectRequest};
use crate::fit::region::HalfSpaces;
use crate::fit::spacing::Spacing;
use crate::fit::stability::Stability;
use crate::fit::visible::{self, Seen};

/// Is the largest distance in texels, from the highest receiver, to which casters whose bounds
/// reach from there to below all receivers move the near plane. The limit prevents one object with
/// bounds of a million kilometres from taking the precision of the depths from all others: depths
/// are f32, and their rounding comes to three texels at this range. The distance is 84 km for
/// texels of one centimetre. The parts of such casters that are nearer to the light cast nothing.
const MAX_TEXELS_TO_NEAR: f64 = (1 << 23) as f64;

/// Limits, as a fraction of a map's side, the height above its receivers that a part needs for the
/// map to cover it. In coarse maps, shadows are visible that are smaller than the gap that the bias
/// admits.
const MAX_GAP_SHARE: f64 = 1.0 / 64.0;

/// Holds what the fit of a cascade needs to know of the frame.
pub(crate) struct Cascade<'a> {
    pub input: &'a FitInput<'a>,
    pub limits: &'a FitLimits,
    /// Has one entry per caster.
    pub casters: &'a [CasterBounds],
    /// Holds the parts of divided casters, the highest first. Only these parts of a divided caster
    /// count.
    pub parts: &'a [CasterPart],
    /// Counts the texels of its map along x and y.
    pub size_texels: UVec2,
    /// Holds what cameras see.
    pub seen: &'a [Seen],
    /// Holds the depths along the view between which the cascade lies; `None` without a camera.
    pub between: Option<(f64, f64)>,
}

impl Cascade<'_> {
    /// Returns the light-space bounds for receivers in `required`: the area, seen from the light,
    /// that both receivers and casters cover. Where rounding makes it doubtful whether a caster
    /// reaches the receivers, it counts as reaching them. Returns `None` where no caster does.
    pub fn fit(
        &self,
        required: &LightBox,
        spacing: Spacing,
        held: Option<&HeldBounds>,
    ) -> Option<HeldBounds> {
        let limits = self.limits;
        let shadows = self.shadows(required, spacing)?;
        let received = if self.follows_casters() {
            self.shadowed_part(required, &shadows, spacing)
        } else {
            *required
        };
        let texel_floor = self
            .input
            .texel_floor(&received, received.max.z)
            .max(spacing.finest_texel());
        let (min, max) = spacing.grown(
            (received.min.truncate(), received.max.truncate()),
            self.size_texels,
            texel_floor,
        );
        let request = MapRectRequest {
            min,
            max,
            size_texels: self.size_texels,
            margin_texels: limits.margin_texels,
            texel_floor,
            full_half_side: f64::INFINITY,
        };
        let rect = HeldRect::fit(&request, held.map(|held| &held.rect));
        let texel = rect.rect.texel.max_element();
        let depth = |near: f64| {
            HeldDepth::fit(
                received.min.z,
                near,
                texel.max(spacing.least_depth()),
                held.map(|held| &held.depth),
            )
        };
        let reaching = LightSpaceBounds {
            rect: rect.rect,
            depth: depth(shadows.max.z.max(received.min.z)).depth,
        };
        let nearest_allowed = received.max.z + MAX_TEXELS_TO_NEAR * texel;
        let nearest = self.nearest_caster(&reaching, spacing, received.min.z, nearest_allowed);
        Some(HeldBounds {
            rect,
            depth: depth(nearest),
        })
    }

    /// Returns whether the bounds hold no more of the receivers than what casters reach.
    fn follows_casters(&self) -> bool {
        match self.input.region {
            Region::Bounds(_) => false,
            Region::Everything => true,
            Region::Cameras(_) => self.limits.stability == Stability::TightFit,
        }
    }

    /// Returns the light-space box of all that visibly shadows receivers in `required`, or `None`
    /// where nothing does.
    pub fn shadows(&self, required: &LightBox, spacing: Spacing) -> Option<LightBox> {
        let gap_share = if self.follows_casters() {
            let side = f64::from(self.size_texels.min_element());
            (self.limits.gap_texels / side).min(MAX_GAP_SHARE)
        } else {
            0.0
        };
        self.shadow_box(required, spacing, gap_share)
    }

    /// Returns the part of `required`, which holds all receivers, onto which the casters in
    /// `shadows` cast, with the depths of the receivers there.
    fn shadowed_part(&self, required: &LightBox, shadows: &LightBox, spacing: Spacing) -> LightBox {
        let mut part = *required;
        part.min = required.min.max(shadows.min).with_z(required.min.z);
        part.max = required.max.min(shadows.max).max(part.min);
        part.max.z = required.max.z;
        // Only the part of a wide ground that the map covers counts for its depths.
        if let Some((farthest, nearest)) = self.depths_over(&part.grown(spacing.error())) {
            part.min.z = farthest.max(required.min.z);
            part.max.z = nearest.min(required.max.z);
        }
        part
    }

    /// Returns the light-space box of all that can shadow receivers in `required`, or `None` where
    /// nothing can.
    ///
    /// A part that rises above its receivers by less than the gap that the bias may leave has no
    /// visible shadow, so the map does not cover a ground for the sake of a carpet on it.
    /// `gap_share` is that gap as a fraction of the side of what the map covers.
    fn shadow_box(
        &self,
        required: &LightBox,
        spacing: Spacing,
        gap_share: f64,
    ) -> Option<LightBox> {
        let reaches = |light: &LightBox| {
            let light = spacing.widest(light);
            light.max.z > required.min.z && light.overlaps_xy(required)
        };
        let mut shadows = LightBox::EMPTY;
        for caster in self.casters.iter().filter(|caster| caster.can_shadow) {
            if reaches(&caster.light) {
                shadows.union(&caster.light);
            }
        }
        for part in self.parts.iter().filter(|part| reaches(&part.light)) {
            let mut grown = shadows;
            grown.union(&part.light);
            let side = grown
                .intersection_xy(required)
                .map_or(0.0, |all| all.widest_side());
            if part.height < gap_share * side {
                break;
            }
            shadows = grown;
        }
        (!shadows.is_empty()).then_some(shadows)
    }

    /// Returns z of the point nearest to the light of all casters that reach into `reaching`, and
    /// at least `farthest`, z of the deepest receiver. A caster that goes on from below all
    /// receivers to beyond `nearest_allowed` counts up to there.
    ///
    /// Only the part of a caster inside the extruded map rectangle counts: the far end of a wide
    /// ground does not. The quantized bounds are larger than was requested, so this also includes
    /// casters that touch only their border.
    fn nearest_caster(
        &self,
        reaching: &LightSpaceBounds,
        spacing: Spacing,
        farthest: f64,
        nearest_allowed: f64,
    ) -> f64 {
        let space = &self.input.space;
        let mut over_rect = HalfSpaces::default();
        let sides = (reaching.rect.min, reaching.rect.max());
        push_extruded_rect(&mut over_rect, space, sides);
        let whole = self.casters.iter().zip(self.input.casters);
        let whole = whole.filter(|(caster, _)| caster.can_shadow);
        let whole = whole.map(|(caster, bounds)| (&caster.light, bounds, &caster.light));
        let parts = self.parts.iter().map(|part| {
            let of = &self.casters[part.caster as usize];
            (&part.light, &part.bounds, &of.light)
        });
        let mut nearest = farthest;
        for (light, bounds, whole_light) in whole.chain(parts) {
            let light = spacing.widest(light);
            if light.max.z > nearest && reaching.holds_part_of(&light) {
                let surrounds_receivers =
                    whole_light.min.z <= farthest && whole_light.max.z >= nearest_allowed;
                let limit = if surrounds_receivers {
                    nearest_allowed
                } else {
                    f64::INFINITY
                };
                over_rect.visit_vertices(bounds, |vertex| {
                    nearest = nearest.max(space.depth(vertex).min(limit));
                });
            }
        }
        nearest
    }

    /// Returns z of the receivers farthest from the light and nearest to it, within the sides of
    /// `covered`; `None` where there is none.
    fn depths_over(&self, covered: &LightBox) -> Option<(f64, f64)> {
        let space = &self.input.space;
        let mut over = HalfSpaces::default();
        let sides = (covered.min.truncate(), covered.max.truncate());
        push_extruded_rect(&mut over, space, sides);
        let mut depths = (f64::INFINITY, f64::NEG_INFINITY);
        let mut include = |vertex: DVec3| {
            let z = space.depth(vertex);
            depths = (depths.0.min(z), depths.1.max(z));
        };
        match self.input.region {
            Region::Bounds(_) => {}
            Region::Everything => {
                for (bounds, _) in self.input.receivers.iter() {
                    over.visit_vertices(bounds, &mut include);
                }
            }
            Region::Cameras(cameras) => {
                for camera in cameras.iter().enumerate() {
                    visible::visit_between(camera, self.seen, self.between?, &over, &mut include);
                }
            }
        }
        (depths.0 <= depths.1).then_some(depths)
    }
}
