//! Fits the cascades of a directional light to the visible receivers and to every caster that can
//! reach them.

use glam::DVec3;

use crate::fit::axes::{LightAxes, LightBox};
use crate::fit::cascade_bounds::Cascade;
use crate::fit::cascade_layout::CascadeLayout;
use crate::fit::caster_parts::{Casters, PartScratch};
use crate::fit::directional_input::{CasterBounds, FitInput, FitLimits, Region};
use crate::fit::extruded_rect::ExtrudedRect;
use crate::fit::footprint::{FootprintScratch, SliceReport};
use crate::fit::layout::HeldLayout;
use crate::fit::layout_choice::{Layout, Prediction};
use crate::fit::layout_samples::{SampleScratch, Sampled};
use crate::fit::map_rect::{HeldBounds, HeldDepth, LightSpaceBounds};
use crate::fit::required::{camera_slice, checked_spacing, held_depths, required_box};
use crate::fit::spacing::Spacing;
use crate::fit::split::MAX_CASCADES;
use crate::fit::visible::{SeenBounds, SeenLists};
use crate::{Aabb, ShadowError};

/// Is the cosine of the largest angle, about a degree, by which a light may turn from one frame to
/// the next and keep the history of its extents. A sun that follows the time of day turns by less
/// in a frame, even where a day takes twenty seconds; a change of scene turns it by more.
const TURN_COSINE: f64 = 0.999_85;

/// Holds the light-space bounds of a light's cascades, kept from frame to frame for their
/// hysteresis.
#[derive(Clone, Debug, Default)]
pub(crate) struct DirectionalFit {
    /// Has one entry per cascade, `None` for a cascade in which nothing can cast a shadow.
    pub light_bounds: [Option<LightSpaceBounds>; MAX_CASCADES],
    held: [Option<HeldBounds>; MAX_CASCADES],
    /// Holds the axes of the light in the last frame.
    axes: Option<LightAxes>,
    /// Holds the depths along the view between which receivers are visible.
    held_depths: Option<HeldDepth>,
    /// Describes the slices of the cascades of a camera's view.
    pub slices: [Option<SliceReport>; MAX_CASCADES],
    /// Holds the layout that was found, where none is given.
    layout: Option<HeldLayout>,
}

/// Holds lists that are reused from frame to frame.
#[derive(Debug, Default)]
pub(crate) struct FitScratch {
    /// Has one entry per caster, in order.
    casters: Vec<CasterBounds>,
    lists: SeenLists,
    parts: PartScratch,
    footprint: FootprintScratch,
    samples: SampleScratch,
}

impl DirectionalFit {
    /// Returns whether the extents of the last frame apply to a light with `axes`. A light that
    /// turns by a large angle moves all shadows, so that none of them needs to keep its texels.
    fn holds_for(&self, axes: &LightAxes) -> bool {
        self.axes.is_some_and(|held| {
            held.toward_light().dot(axes.toward_light()) > TURN_COSINE
                && held.up().dot(axes.up()) > TURN_COSINE
        })
    }

    /// Returns the fit for this frame and fills `scratch.casters`.
    ///
    /// Returns an error where casters and receivers are so far from the world's origin that f64
    /// does not distinguish their positions.
    pub fn fit(
        &self,
        input: &FitInput<'_>,
        limits: &FitLimits,
        scratch: &mut FitScratch,
    ) -> Result<Self, ShadowError> {
        let visible = find_visible(input, &mut scratch.lists);
        scratch.casters.clear();
        scratch
            .casters
            .extend(input.casters.iter().map(|bounds| CasterBounds {
                light: input.space.bounds(bounds),
                can_shadow: !bounds.is_empty()
                    && can_shadow(bounds, &visible, input.space.axes.toward_light()),
            }));
        divide_casters(input, &visible, scratch);
        let any_casts = scratch.casters.iter().any(|caster| caster.can_shadow)
            || !scratch.parts.parts.is_empty();
        let history = if self.holds_for(&input.space.axes) {
            self.clone()
        } else {
            Self::default()
        };
        let mut next = history.clone();
        next.axes = Some(input.space.axes);
        let depths = held_depths(&visible, history.held_depths.as_ref());
        next.held_depths = depths.or(history.held_depths);
        let limits = &next.find_layout(input, limits, &visible, scratch);
        if next.layout() != history.layout() {
            next.held = Default::default();
        }
        for cascade in 0..limits.cascades {
            let depths = next.held_depths.as_ref();
            let slice = camera_slice(input, limits, &visible, depths, cascade);
            let seen = &scratch.lists.seen;
            let required = required_box(input, limits, slice.as_ref(), seen, cascade);
            let held = next.held[cascade].as_ref();
            let held_bounds = match required {
                Some(required) if any_casts => {
                    let spacing = checked_spacing(input, limits, slice.as_ref(), &required)?;
                    let cascade = Cascade {
                        input,
                        limits,
                        casters: &scratch.casters,
                        parts: &scratch.parts.parts,
                        size_texels: limits.rects[cascade].size,
                        seen,
                        between: slice.as_ref().map(|slice| slice.between),
                    };
                    cascade.fit(&required, spacing, held)
                }
                _ => None,
            };
            next.held[cascade] = held_bounds.or(next.held[cascade]);
            let light_bounds = held_bounds.map(|held| held.bounds());
            next.light_bounds[cascade] = light_bounds;
            next.slices[cascade] = slice.zip(light_bounds).map(|(slice, light_bounds)| {
                let scratch = &mut scratch.footprint;
                slice.report(&input.space, &light_bounds.rect, scratch)
            });
        }
        Ok(next)
    }

    /// Returns the settings for this frame, with the layout that is found where none is given.
    fn find_layout(
        &mut self,
        input: &FitInput<'_>,
        limits: &FitLimits,
        visible: &SeenBounds,
        scratch: &mut FitScratch,
    ) -> FitLimits {
        if limits.layout == CascadeLayout::Fixed {
            return *limits;
        }
        let depths = self.held_depths.as_ref();
        let sampled = Sampled {
            input,
            seen: &scratch.lists.seen,
            casters: &scratch.casters,
            parts: &scratch.parts.parts,
        };
        let samples = &mut scratch.samples;
        let held = HeldLayout::next(self.layout.as_ref(), limits.map_size, move || {
            Prediction::of(&sampled, limits, visible, depths, samples)
        });
        self.layout = Some(held);
        held.layout.applied(limits)
    }

    /// Returns the layout that was found, where none is given.
    pub fn layout(&self) -> Option<&Layout> {
        self.layout.as_ref().map(|held| &held.layout)
    }

    /// Returns the error that was predicted for that layout.
    pub fn predicted_error(&self) -> Option<f64> {
        self.layout.map(|held| held.predicted_error)
    }

    /// Returns the light-space bounds of a cascade that something casts into, and adds its casters
    /// to `drawn`: those of which some part is within the map rectangle, seen along the light, and
    /// in front of the far plane. `scratch` is the one that the fit has filled.
    pub fn cull(
        &self,
        cascade: usize,
        input: &FitInput<'_>,
        scratch: &FitScratch,
        drawn: &mut Vec<u32>,
    ) -> Option<&LightSpaceBounds> {
        let light_bounds = self.light_bounds[cascade].as_ref()?;
        let spacing = Spacing::around(input.space.origin, &light_bounds.bounds());
        let volume = ExtrudedRect::new(&input.space, &light_bounds.rect);
        let reaches = |light: &LightBox, bounds: &Aabb| {
            light_bounds.holds_part_of(&spacing.widest(light)) && volume.meets(bounds)
        };
        let all = (0u32..).zip(scratch.casters.iter().zip(input.casters));
        drawn.extend(all.filter_map(|(index, (caster, bounds))| {
            (caster.can_shadow && reaches(&caster.light, bounds)).then_some(index)
        }));
        let parts = scratch.parts.parts.iter();
        drawn.extend(
            parts.filter_map(|part| reaches(&part.light, &part.bounds).then_some(part.caster)),
        );
        if !scratch.parts.parts.is_empty() {
            drawn.sort_unstable();
            drawn.dedup();
        }
        Some(light_bounds)
    }
}

/// Fills `lists` with the parts of the receivers that count, and returns the bounds of all of them.
fn find_visible(input: &FitInput<'_>, lists: &mut SeenLists) -> SeenBounds {
    match &input.region {
        Region::Bounds(bounds) => SeenBounds::of_boxes([bounds]),
        Region::Everything => {
            lists.set_whole(input.receivers);
            SeenBounds::of_boxes(input.receivers.bounds)
        }
        Region::Cameras(cameras) => lists.find(cameras, input.receivers),
    }
}

/// Replaces casters that are much larger than all others by the parts of them that count. In a
/// given box everything receives, so that all of a caster counts.
fn divide_casters(input: &FitInput<'_>, visible: &SeenBounds, scratch: &mut FitScratch) {
    if matches!(input.region, Region::Bounds(_)) {
        return scratch.parts.clear();
    }
    let casters = Casters {
        space: &input.space,
        bounds: input.casters,
        shapes: input.shapes,
    };
    let visible = Aabb::around(visible.render_min, visible.render_max);
    let visible = input.space.bounds(&visible);
    let candidates = (0u32..).zip(&scratch.casters);
    let candidates = candidates.filter(|(_, caster)| caster.can_shadow);
    let candidates = candidates.map(|(index, caster)| (index, caster.light));
    let parts = &mut scratch.parts;
    parts.find(&casters, candidates, &visible, &scratch.lists.parts);
    for &caster in &parts.divided {
        scratch.casters[caster as usize].can_shadow = false;
    }
}

/// Returns whether a shadow of `caster` can fall on anything visible. A point is shadowed by a
/// point of the caster further along the way to the light, so on each world axis the caster must
/// reach beyond the receivers' near end in the light's direction. A flat floor under everything
/// else fails this (it reaches just as far as the lowest receiver: itself), and neither widens the
/// light-space bounds nor is drawn.
fn can_shadow(caster: &Aabb, receivers: &SeenBounds, toward_light: DVec3) -> bool {
    let (low, high) = (caster.min.as_dvec3(), caster.max.as_dvec3());
    (0..3).all(|axis| {
        let toward = toward_light[axis];
        if toward > 0.0 {
            high[axis] > receivers.render_min[axis]
        } else if toward < 0.0 {
            low[axis] < receivers.render_max[axis]
        } else {
            high[axis] >= receivers.render_min[axis] && low[axis] <= receivers.render_max[axis]
        }
    })
}
