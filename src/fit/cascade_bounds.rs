//! Fits the light-space bounds of one cascade of a directional light.

use std::cell::Cell;

use glam::{DVec3, UVec2};

use crate::Aabb;
use crate::fit::axes::LightBox;
use crate::fit::caster_parts::CasterPart;
use crate::fit::directional_casters::DirectionalCasters;
use crate::fit::directional_input::{FitInput, FitLimits, Region};
use crate::fit::extruded_rect::push_extruded_rect;
use crate::fit::map_rect::{
    BoundsRequest, HeldBounds, HeldDepth, HeldRect, LightSpaceBounds, MapRectRequest,
};
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
    /// Holds the casters that count as a whole.
    pub casters: DirectionalCasters<'a>,
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
    /// reaches the receivers, it counts as reaching them. The second value is what the bounds
    /// were fitted to. Returns `None` where no caster does.
    pub(super) fn fit(
        &self,
        required: &LightBox,
        spacing: Spacing,
        held: Option<&HeldBounds>,
    ) -> Option<(HeldBounds, BoundsRequest)> {
        let limits = self.limits;
        let shadows = self.shadows(required, required, spacing)?;
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
        let least_depth = texel.max(spacing.least_depth());
        let held_depth = held.map(|held| &held.depth);
        let depth = |near: f64| HeldDepth::fit(received.min.z, near, least_depth, held_depth);
        let highest = shadows.max.z.max(received.min.z);
        let reaching = LightSpaceBounds {
            rect: rect.rect,
            depth: depth(highest).depth,
        };
        let nearest_allowed = received.max.z + MAX_TEXELS_TO_NEAR * texel;
        let nearest = self.nearest_caster(&reaching, spacing, received.min.z, nearest_allowed);
        let bounds = HeldBounds {
            rect,
            depth: depth(nearest),
        };
        let request = BoundsRequest {
            rect: request,
            far: received.min.z,
            highest,
            nearest,
            least_depth,
            reaching: reaching.depth,
        };
        Some((bounds, request))
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
    /// where nothing does. Across the light it is the part inside `window`, which holds `required`.
    /// Its farthest depth means nothing.
    pub(super) fn shadows(
        &self,
        required: &LightBox,
        window: &LightBox,
        spacing: Spacing,
    ) -> Option<LightBox> {
        let gap_share = if self.follows_casters() {
            let side = f64::from(self.size_texels.min_element());
            (self.limits.gap_texels / side).min(MAX_GAP_SHARE)
        } else {
            0.0
        };
        let shadows = self.shadow_box(required, window, spacing, gap_share)?;
        Some(LightBox {
            min: shadows
                .min
                .clamp(window.min, window.max)
                .with_z(shadows.min.z),
            max: shadows
                .max
                .clamp(window.min, window.max)
                .with_z(shadows.max.z),
        })
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

    /// Returns a light-space box that has the same part inside `window` as that of all that can
    /// shadow receivers in `required`, and the same greatest depth; `None` where nothing can.
    ///
    /// A part that rises above its receivers by less than the gap that the bias may leave has no
    /// visible shadow, so the map does not cover a ground for the sake of a carpet on it.
    /// `gap_share` is that gap as a fraction of the side of what the map covers.
    fn shadow_box(
        &self,
        required: &LightBox,
        window: &LightBox,
        spacing: Spacing,
        gap_share: f64,
    ) -> Option<LightBox> {
        let reaches = |light: &LightBox| {
            let light = spacing.widest(light);
            light.max.z > required.min.z && light.overlaps_xy(required)
        };
        let mut shadows = LightBox::EMPTY;
        self.casters.walk(
            spacing,
            &mut shadows,
            |shadows, around| {
                let adds = || {
                    let part = around.intersection_xy(window);
                    part.is_none_or(|part| !shadows.holds_xy(&part))
                };
                around.max.z > required.min.z
                    && around.overlaps_xy(required)
                    && (around.max.z > shadows.max.z || adds())
            },
            |shadows, _, _, light| {
                if reaches(light) {
                    shadows.union(light);
                }
            },
        );
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
        let nearest = Cell::new(farthest);
        let reaches = |light: &LightBox| {
            let light = spacing.widest(light);
            light.max.z > nearest.get() && reaching.holds_part_of(&light)
        };
        let include = |bounds: &Aabb, whole: &LightBox| {
            let surrounds_receivers = whole.min.z <= farthest && whole.max.z >= nearest_allowed;
            let limit = if surrounds_receivers {
                nearest_allowed
            } else {
                f64::INFINITY
            };
            over_rect.visit_vertices(bounds, |vertex| {
                nearest.set(nearest.get().max(space.depth(vertex).min(limit)));
            });
        };
        self.casters.walk(
            spacing,
            &mut (),
            |(), around| around.max.z > nearest.get() && reaching.holds_part_of(around),
            |(), _, bounds, light| {
                if reaches(light) {
                    include(bounds, light);
                }
            },
        );
        for part in self.parts.iter().filter(|part| reaches(&part.light)) {
            include(
                &part.bounds,
                &space.bounds(self.casters.boxes.at(part.caster)),
            );
        }
        nearest.get()
    }

    /// Returns z of the receivers farthest from the light and nearest to it, within the sides of
    /// `covered`; `None` where there is none.
    fn depths_over(&self, covered: &LightBox) -> Option<(f64, f64)> {
        let space = &self.input.space;
        let mut over = HalfSpaces::default();
        let sides = (covered.min.truncate(), covered.max.truncate());
        push_extruded_rect(&mut over, space, sides);
        let depths = Cell::new((f64::INFINITY, f64::NEG_INFINITY));
        let include = |vertex: DVec3| {
            let (z, (farthest, nearest)) = (space.depth(vertex), depths.get());
            depths.set((farthest.min(z), nearest.max(z)));
        };
        let adds = |bounds: &Aabb| {
            let (light, (farthest, nearest)) = (space.bounds(bounds), depths.get());
            let held = LightBox {
                min: light.min.with_z(farthest),
                max: light.max.with_z(nearest),
            };
            !held.surely_holds_depths(&light)
        };
        match self.input.region {
            Region::Bounds(_) => {}
            Region::Everything => self.input.receivers.walk(
                &mut (),
                |(), around| !over.surely_misses(around) && adds(around),
                |(), _, bounds| {
                    if adds(bounds) {
                        over.visit_vertices(bounds, include);
                    }
                },
            ),
            Region::Cameras(cameras) => {
                for camera in cameras.iter().enumerate() {
                    visible::visit_between(camera, self.seen, self.between?, &over, adds, include);
                }
            }
        }
        let depths = depths.get();
        (depths.0 <= depths.1).then_some(depths)
    }
}
