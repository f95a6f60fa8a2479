//! Fits the light-space bounds of one cascade of a directional light.

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

/// Holds the casters of a frame, as the fit of a cascade needs them.
pub(crate) struct CascadeCasters<'a> {
    /// Has one entry per caster.
    pub whole: &'a [CasterBounds],
    /// Holds the parts of divided casters, the highest first. Only these parts of a divided caster
    /// count.
    pub parts: &'a [CasterPart],
}

/// Returns the light-space bounds for receivers in `required`: the area, seen from the light, that
/// both receivers and casters cover. Where rounding makes it doubtful whether a caster reaches the
/// receivers, it counts as reaching them. Returns `None` where no caster does. `seen` holds what
/// cameras see, and the depths along the view between which the cascade lies.
pub(crate) fn fit_bounds(
    input: &FitInput<'_>,
    limits: &FitLimits,
    casters: &CascadeCasters<'_>,
    (required, spacing): (LightBox, Spacing),
    seen: (&[Seen], Option<(f64, f64)>),
    held: Option<&HeldBounds>,
) -> Option<HeldBounds> {
    let follows_casters = match input.region {
        Region::Bounds(_) => false,
        Region::Everything => true,
        Region::Cameras(_) => limits.stability == Stability::TightFit,
    };
    let gap_share = if follows_casters {
        (limits.gap_texels / f64::from(limits.map_size)).min(MAX_GAP_SHARE)
    } else {
        0.0
    };
    let shadows = shadow_box(casters, &required, spacing, gap_share)?;
    let mut covered = required;
    if follows_casters {
        covered.min = required.min.max(shadows.min).with_z(required.min.z);
        covered.max = required
            .max
            .min(shadows.max)
            .max(covered.min)
            .with_z(required.max.z);
        // Only the part of a wide ground that the map covers counts for its depths.
        if let Some((farthest, nearest)) = depths_over(input, seen, &covered.grown(spacing.error()))
        {
            covered.min.z = farthest.max(required.min.z);
            covered.max.z = nearest.min(required.max.z);
        }
    }
    let highest_receiver = covered.max.z;
    covered.max.z = shadows.max.z.max(covered.min.z);
    let texel_floor = input
        .texel_floor(&covered, highest_receiver)
        .max(spacing.finest_texel());
    let (min, max) = spacing.grown(
        (covered.min.truncate(), covered.max.truncate()),
        limits.map_size,
        texel_floor,
    );
    let request = MapRectRequest {
        min,
        max,
        map_size: limits.map_size,
        margin_texels: limits.margin_texels,
        texel_floor,
        full_half_side: f64::INFINITY,
    };
    let held_rect = HeldRect::fit(&request, held.map(|held| &held.rect));
    let rect = held_rect.rect;
    let least_range = rect.texel.max_element().max(spacing.least_depth());
    let nearest_allowed = highest_receiver + MAX_TEXELS_TO_NEAR * rect.texel.max_element();
    let depth = |near: f64| {
        HeldDepth::fit(
            covered.min.z,
            near,
            least_range,
            held.map(|held| &held.depth),
        )
    };
    let light_bounds = LightSpaceBounds {
        rect,
        depth: depth(covered.max.z).depth,
    };
    // Only the part of a caster inside the extruded map rectangle counts for the near plane: the
    // far end of a wide ground does not. The quantized light-space bounds are larger than was
    // requested, so this also includes casters that touch only their border.
    let mut over_rect = HalfSpaces::default();
    push_extruded_rect(
        &mut over_rect,
        &input.axes,
        input.origin,
        (rect.min, rect.max()),
    );
    let whole = casters.whole.iter().zip(input.casters);
    let whole = whole.filter(|(caster, _)| caster.can_shadow);
    let whole = whole.map(|(caster, bounds)| (&caster.light, bounds, &caster.light));
    let parts = casters.parts.iter().map(|part| {
        let of = &casters.whole[part.caster as usize];
        (&part.light, &part.bounds, &of.light)
    });
    let mut nearest = covered.min.z;
    for (light, bounds, whole_light) in whole.chain(parts) {
        let light = spacing.widest(light);
        if light.max.z > nearest && light_bounds.holds_part_of(&light) {
            let surrounds_receivers =
                whole_light.min.z <= covered.min.z && whole_light.max.z >= nearest_allowed;
            let limit = if surrounds_receivers {
                nearest_allowed
            } else {
                f64::INFINITY
            };
            over_rect.visit_vertices(bounds, |vertex| {
                let z = input.axes.toward_light().dot(input.origin + vertex);
                nearest = nearest.max(z.min(limit));
            });
        }
    }
    Some(HeldBounds {
        rect: held_rect,
        depth: depth(nearest),
    })
}

/// Returns the light-space box of all that can shadow receivers in `required`, or `None` where
/// nothing can.
///
/// A part that rises above its receivers by less than the gap that the bias may leave has no
/// visible shadow, so the map does not cover a ground for the sake of a carpet on it. `gap_share`
/// is that gap as a fraction of the side of what the map covers.
fn shadow_box(
    casters: &CascadeCasters<'_>,
    required: &LightBox,
    spacing: Spacing,
    gap_share: f64,
) -> Option<LightBox> {
    let reaches = |light: &LightBox| {
        let light = spacing.widest(light);
        light.max.z > required.min.z && light.overlaps_xy(required)
    };
    let mut shadows = LightBox::EMPTY;
    for caster in casters.whole.iter().filter(|caster| caster.can_shadow) {
        if reaches(&caster.light) {
            shadows.union(&caster.light);
        }
    }
    for part in casters.parts.iter().filter(|part| reaches(&part.light)) {
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

/// Returns the light-space depths of the farthest and the nearest receiver, seen from the light,
/// within the sides of `covered`; `None` where there is none.
fn depths_over(
    input: &FitInput<'_>,
    (seen, between): (&[Seen], Option<(f64, f64)>),
    covered: &LightBox,
) -> Option<(f64, f64)> {
    let mut over = HalfSpaces::default();
    let sides = (covered.min.truncate(), covered.max.truncate());
    push_extruded_rect(&mut over, &input.axes, input.origin, sides);
    let mut depths = (f64::INFINITY, f64::NEG_INFINITY);
    let mut include = |z: f64| depths = (depths.0.min(z), depths.1.max(z));
    match input.region {
        Region::Bounds(_) => {}
        Region::Everything => {
            for (bounds, _) in input.receivers.iter() {
                over.visit_vertices(bounds, |vertex| {
                    include(input.axes.toward_light().dot(input.origin + vertex));
                });
            }
        }
        Region::Cameras(cameras) => {
            let between = between?;
            for camera in cameras.iter().enumerate() {
                let over = &over;
                visible::visit_between(camera, seen, between, over, |vertex| {
                    include(input.axes.toward_light().dot(input.origin + vertex));
                });
            }
        }
    }
    (depths.0 <= depths.1).then_some(depths)
}
