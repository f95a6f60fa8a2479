//! Fits the cascades of a directional light to the visible receivers and to every caster that can
//! reach them.

use crate::fit::axes::{LightAxes, LightBox, LightSpace};
use crate::fit::boxes::Boxes;
use crate::fit::camera::CameraFrustum;
use crate::fit::cascade_bounds::Cascade;
use crate::fit::caster_parts::PartScratch;
use crate::fit::change_log::ChangedBoxes;
use crate::fit::culling::HeldVisible;
use crate::fit::directional_casters::{DirectionalCaster, DirectionalCasters, light_box_around};
use crate::fit::directional_input::{FitInput, FitLimits, Region};
use crate::fit::extruded_rect::ExtrudedRect;
use crate::fit::footprint::{FootprintScratch, SliceReport};
use crate::fit::layout::HeldLayout;
use crate::fit::layout_choice::{Layout, Prediction};
use crate::fit::layout_samples::{SampleScratch, Sampled};
use crate::fit::map_rect::{BoundsRequest, HeldBounds, HeldDepth, LightSpaceBounds};
use crate::fit::required::{camera_slice, checked_spacing, held_depths, is_fine, required_box};
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
    /// Holds what each of `light_bounds` was fitted to.
    requests: [Option<BoundsRequest>; MAX_CASCADES],
    /// Bounds what was visible.
    visible: Option<SeenBounds>,
    /// Holds what the casters of each cascade are culled for.
    held_visible: [Option<HeldVisible>; MAX_CASCADES],
    /// Holds the axes of the light in the last frame.
    axes: Option<LightAxes>,
    /// Holds the depths along the view between which receivers are visible.
    held_depths: Option<HeldDepth>,
    /// Describes the slices of the cascades of a camera's view.
    pub slices: [Option<SliceReport>; MAX_CASCADES],
    /// Holds the layout that was found, where none is given.
    layout: Option<HeldLayout>,
    /// Holds, across the light, all casters that the fit depends on; `None` where it may depend on
    /// any.
    influence: Option<LightBox>,
}

/// Holds lists that are reused from frame to frame.
#[derive(Debug)]
pub(crate) struct FitScratch {
    /// Bounds what is visible in this frame.
    visible: SeenBounds,
    /// Holds the casters that can shadow something, where no tree finds them.
    casters: Vec<DirectionalCaster>,
    lists: SeenLists,
    parts: PartScratch,
    footprint: FootprintScratch,
    samples: SampleScratch,
}

impl Default for FitScratch {
    fn default() -> Self {
        Self {
            visible: SeenBounds::NOTHING,
            casters: Vec::new(),
            lists: SeenLists::default(),
            parts: PartScratch::default(),
            footprint: FootprintScratch::default(),
            samples: SampleScratch::default(),
        }
    }
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

    /// Returns the fit for this frame and fills `scratch`.
    ///
    /// Returns an error where casters and receivers are so far from the world's origin that f64
    /// does not distinguish their positions.
    pub(crate) fn fit(
        &self,
        input: &FitInput<'_>,
        limits: &FitLimits,
        scratch: &mut FitScratch,
    ) -> Result<Self, ShadowError> {
        let visible = find_visible(input, &mut scratch.lists);
        scratch.visible = visible;
        let held = self.held_visible.iter().flatten();
        let shadowed = held.fold(visible, |all, held| all.union(&held.visible));
        DirectionalCasters::list(&input.space, input.casters, &shadowed, &mut scratch.casters);
        divide_casters(input, scratch);
        let casters = scratch.whole_casters(&input.space, input.casters);
        let any_casts = !scratch.parts.parts.is_empty()
            || casters.any(Spacing::around(input.space.origin, &LightBox::EMPTY));
        let history = if self.holds_for(&input.space.axes) {
            self.clone()
        } else {
            Self::default()
        };
        let mut next = history.clone();
        next.requests = Default::default();
        next.axes = Some(input.space.axes);
        next.visible = Some(visible);
        let depths = held_depths(&visible, history.held_depths.as_ref());
        next.held_depths = depths.or(history.held_depths);
        let mut influence = LightBox::EMPTY;
        if visible.render_min.cmple(visible.render_max).all() {
            influence.union(&visible_box(&input.space, &visible));
        }
        let mut depends_on_all = false;
        let limits = &next.find_layout(input, limits, &visible, scratch);
        if next.layout() != history.layout() {
            next.held = Default::default();
        }
        for cascade in 0..limits.cascades {
            let depths = next.held_depths.as_ref();
            let slice = camera_slice(input, limits, &visible, depths, cascade);
            let seen = &scratch.lists.seen;
            let required = required_box(input, limits, slice.as_ref(), seen, cascade);
            if let Some(required) = &required {
                influence.union(required);
                depends_on_all |= !is_fine(input, required);
            }
            let held = next.held[cascade].as_ref();
            let held_bounds = match required {
                Some(required) if any_casts => {
                    let spacing = checked_spacing(input, limits, slice.as_ref(), &required)?;
                    let cascade = Cascade {
                        input,
                        limits,
                        casters: scratch.whole_casters(&input.space, input.casters),
                        parts: &scratch.parts.parts,
                        size_texels: limits.rects[cascade].size,
                        seen,
                        between: slice.as_ref().map(|slice| slice.between),
                    };
                    cascade.fit(&required, spacing, held)
                }
                _ => None,
            };
            let (held_bounds, request) = held_bounds.unzip();
            next.requests[cascade] = request;
            next.held[cascade] = held_bounds.or(next.held[cascade]);
            let light_bounds = held_bounds.map(|held| held.bounds());
            let is_held = light_bounds == history.light_bounds[cascade];
            let held_visible = history.held_visible[cascade].filter(|_| is_held);
            next.held_visible[cascade] = Some(HeldVisible::following(held_visible, &visible));
            if let Some(light_bounds) = &light_bounds {
                influence.union(&light_bounds.bounds());
            }
            next.light_bounds[cascade] = light_bounds;
            next.slices[cascade] = slice.zip(light_bounds).map(|(slice, light_bounds)| {
                let scratch = &mut scratch.footprint;
                slice.report(&input.space, &light_bounds.rect, scratch)
            });
        }
        next.influence = (!depends_on_all).then_some(influence);
        Ok(next)
    }

    /// Returns the fit for a frame in which nothing differs from the last. Only the time counts for
    /// which extents have been larger than needed. Returns `None` where the whole fit is needed,
    /// because that time is over or a layout is to be chosen.
    pub(crate) fn again(&self) -> Option<Self> {
        let mut next = self.clone();
        let depths = held_depths(self.visible.as_ref()?, self.held_depths.as_ref());
        next.held_depths = depths.or(self.held_depths);
        let same_depths = match (&next.held_depths, &self.held_depths) {
            (Some(next), Some(held)) => next.depth == held.depth,
            (next, held) => next.is_none() == held.is_none(),
        };
        if !same_depths {
            return None;
        }
        for held in next.held_visible.iter_mut().flatten() {
            *held = held.again(self.visible.as_ref()?)?;
        }
        if let Some(layout) = &self.layout {
            next.layout = Some(layout.without_prediction()?);
        }
        for cascade in 0..MAX_CASCADES {
            if self.light_bounds[cascade].is_some() {
                let request = self.requests[cascade].as_ref()?;
                next.held[cascade] = Some(self.held[cascade]?.again(request)?);
            }
        }
        Some(next)
    }

    /// Returns whether the fit may become another, or may have other casters, where these boxes
    /// change. `input` is otherwise that of the last fit.
    pub(crate) fn may_change(&self, input: &FitInput<'_>, changes: ChangedBoxes<'_>) -> bool {
        let (Some(influence), Some(visible)) = (&self.influence, &self.visible) else {
            return true;
        };
        let cameras = match input.region {
            Region::Cameras(cameras) => cameras,
            Region::Bounds(_) => &[],
            Region::Everything => return !changes.is_empty(),
        };
        let space = &input.space;
        let spacing = Spacing::around(space.origin, influence);
        let toward_light = space.axes.toward_light();
        let held = self.held_visible.iter().flatten();
        let visible = held.fold(*visible, |all, held| all.union(&held.visible));
        changes.iter().any(|changed| {
            let bounds = &changed.bounds;
            let is_seen = |camera: &CameraFrustum| !camera.planes.surely_misses(bounds);
            cameras.iter().any(is_seen)
                || visible.can_be_shadowed_by(bounds, toward_light)
                    && light_box_around(space, spacing, bounds).overlaps_xy(influence)
        })
    }

    /// Returns the settings for this frame, with the layout that is found where none is given.
    fn find_layout(
        &mut self,
        input: &FitInput<'_>,
        limits: &FitLimits,
        visible: &SeenBounds,
        scratch: &mut FitScratch,
    ) -> FitLimits {
        if !limits.divides_layer {
            return *limits;
        }
        let depths = self.held_depths.as_ref();
        let sampled = Sampled {
            input,
            seen: &scratch.lists.seen,
            casters: DirectionalCasters {
                space: &input.space,
                boxes: input.casters,
                visible,
                divided: &scratch.parts.divided,
                listed: &scratch.casters,
            },
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
    pub(crate) fn layout(&self) -> Option<&Layout> {
        self.layout.as_ref().map(|held| &held.layout)
    }

    /// Returns the error that was predicted for that layout.
    pub(crate) fn predicted_error(&self) -> Option<f64> {
        self.layout.map(|held| held.predicted_error)
    }

    /// Returns the light-space bounds of a cascade that something casts into, and adds its casters
    /// to `drawn`: those of which some part is within the map rectangle, seen along the light, and
    /// in front of the far plane, and that can shadow what is visible or was of late. `scratch` is
    /// the one that the fit has filled.
    pub(crate) fn cull(
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
        let casters = DirectionalCasters {
            visible: &self.held_visible[cascade].as_ref()?.visible,
            ..scratch.whole_casters(&input.space, input.casters)
        };
        casters.walk(
            spacing,
            drawn,
            |_, around| light_bounds.holds_part_of(around),
            |drawn, index, bounds, light| {
                if reaches(light, bounds) {
                    drawn.push(index);
                }
            },
        );
        let parts = scratch.parts.parts.iter();
        drawn.extend(
            parts.filter_map(|part| reaches(&part.light, &part.bounds).then_some(part.caster)),
        );
        if !scratch.parts.parts.is_empty() || input.casters.tree.is_some() {
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
            SeenBounds::of_boxes(input.receivers.iter().map(|(bounds, _)| bounds))
        }
        Region::Cameras(cameras) => lists.find(cameras, input.receivers),
    }
}

/// Returns the light-space box around all that is visible.
fn visible_box(space: &LightSpace, visible: &SeenBounds) -> LightBox {
    space.bounds(&Aabb::around(visible.render_min, visible.render_max))
}

/// Replaces casters that are much larger than all others by the parts of them that count. In a
/// given box everything receives, so that all of a caster counts.
fn divide_casters(input: &FitInput<'_>, scratch: &mut FitScratch) {
    scratch.parts.clear();
    if matches!(input.region, Region::Bounds(_)) {
        return;
    }
    let visible = &scratch.visible;
    let visible_box = visible_box(&input.space, visible);
    let candidates = DirectionalCasters {
        space: &input.space,
        boxes: input.casters,
        visible,
        divided: &[],
        listed: &scratch.casters,
    };
    let parts = &mut scratch.parts;
    parts.find(&candidates, &visible_box, &scratch.lists.parts);
}

impl FitScratch {
    /// Returns the casters that can shadow something and count as a whole.
    fn whole_casters<'a>(
        &'a self,
        space: &'a LightSpace,
        boxes: Boxes<'a>,
    ) -> DirectionalCasters<'a> {
        DirectionalCasters {
            space,
            boxes,
            visible: &self.visible,
            divided: &self.parts.divided,
            listed: &self.casters,
        }
    }
}
