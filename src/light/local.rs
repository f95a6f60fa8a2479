//! Records spot and point lights, alone or in a pool: fits their perspective views, selects those
//! that are drawn in a frame, and passes them to the maps.

use glam::DVec3;

use crate::cast::ViewDraws;
use crate::fit::{LightAxes, LocalFit, LocalInput, MAX_LOCAL_VIEWS, PerspectiveView, Reached};
use crate::light::distance_limit::range_limit;
use crate::light::scene::FrameVersion;
use crate::receive::{ALL_TEXELS, LayerState, MapsFrame, ShadowMaps, ShadowMapsDescriptor};
use crate::{ShadowError, ShadowFrame, ShadowView, report::ShadowReport};

/// Holds spot or point lights in the slots of one set of maps. A single light has one slot; a pool
/// has as many as its capacity.
#[derive(Debug)]
pub(crate) struct LocalLights {
    maps: ShadowMaps,
    slots: Vec<SlotState>,
    /// States that the device clips depth to -1..1.
    has_symmetric_clip_depth: bool,
    /// Is empty between frames; this list and the next are reused for their memory.
    candidates: Vec<Candidate>,
    layers: Vec<LayerState>,
    reached: Reached,
    /// Is what the maps were last recorded for, with the list after this.
    last_frame: Option<FrameVersion>,
    last_lights: Vec<LocalPlacement>,
    /// Is reused from frame to frame for its memory.
    fits: Vec<LocalFit>,
}

#[derive(Clone, Debug, Default)]
struct SlotState {
    fit: LocalFit,
    /// Counts the frames for which a needed refresh has been deferred.
    waited: u32,
    /// States that the slot's layers have been drawn, or were found to need no drawing, since the
    /// light was inserted.
    has_map: bool,
    /// Holds the views that the layers were last refreshed with.
    views: [Option<ShadowView>; MAX_LOCAL_VIEWS],
    /// Is the position that the light had then.
    position_world: DVec3,
    /// Is the range that the light had then, in world units.
    range: f32,
}

/// Describes a light of a frame, in terms that spot and point lights have in common.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct LocalPlacement {
    pub slot: u32,
    pub position_world: DVec3,
    pub range: f32,
    /// Holds the axes of its views; only the first `view_count` are used.
    pub axes: [LightAxes; MAX_LOCAL_VIEWS],
    pub view_count: u32,
    /// Is the tangent of half the angle of a view, without the border that a filter needs.
    pub tangent: f64,
    /// Is the cosine of the half-angle of the cone; -2 if there is no cone.
    pub cone_cosine: f64,
    /// Determines which lights are refreshed first under a budget.
    pub importance: f32,
}

/// Holds the new fit of a light and the draws that would refresh it.
#[derive(Debug)]
struct Candidate {
    fit: LocalFit,
    draws: [Option<ViewDraws>; MAX_LOCAL_VIEWS],
    /// Holds the views of `draws`.
    views: [Option<ShadowView>; MAX_LOCAL_VIEWS],
    /// Counts the depth passes that its views need.
    needed: u32,
    refreshed: bool,
}

/// Is the least importance that a light with an importance above 0 counts for, as a fraction of the
/// greatest in the frame.
const LEAST_SHARE_OF_IMPORTANCE: f64 = 1.0 / 4096.0;

impl LocalLights {
    /// Makes the maps, and a slot for each of their lights.
    pub fn new(
        device: &wgpu::Device,
        descriptor: &ShadowMapsDescriptor<'_>,
    ) -> Result<Self, ShadowError> {
        Ok(Self {
            maps: ShadowMaps::new(device, descriptor)?,
            has_symmetric_clip_depth: device.adapter_info().backend == wgpu::Backend::Gl,
            slots: vec![SlotState::default(); descriptor.lights as usize],
            candidates: Vec::new(),
            layers: Vec::new(),
            reached: Reached::default(),
            last_frame: None,
            last_lights: Vec::new(),
            fits: Vec::new(),
        })
    }

    /// Returns the maps of all lights.
    pub fn maps(&self) -> &ShadowMaps {
        &self.maps
    }

    /// Declares the contents of the maps invalid, so that the next frame draws every view.
    pub fn invalidate(&mut self) {
        self.maps.invalidate();
    }

    /// Discards the extents of earlier frames.
    pub fn reset_history(&mut self) {
        self.last_frame = None;
        for slot in &mut self.slots {
            slot.fit = LocalFit::default();
        }
    }

    /// Resets the state of a slot, whose next light then has no map until it is drawn.
    pub fn reset(&mut self, slot: u32) {
        self.last_frame = None;
        self.slots[slot as usize] = SlotState::default();
    }

    /// Fits and culls `lights`, uploads their uniforms and records their depth passes. `max_views`
    /// is the largest number of depth passes to record; `None` sets no limit.
    pub fn record(
        &mut self,
        encoder: &mut wgpu::CommandEncoder,
        frame: &ShadowFrame<'_>,
        lights: &[LocalPlacement],
        max_views: Option<u32>,
    ) -> Result<&ShadowReport, ShadowError> {
        if self.is_as_before(frame, lights) {
            self.last_frame = Some(frame.version);
            return Ok(self.maps.keep(&frame.casters));
        }
        self.last_frame = None;
        let mut candidates = std::mem::take(&mut self.candidates);
        candidates.clear();
        for light in lights {
            candidates.push(self.candidate(frame, light)?);
        }
        if let Some(max_views) = max_views {
            self.choose(lights, max_views, &mut candidates);
        }

        let maps = &mut self.maps;
        let mut layers = std::mem::take(&mut self.layers);
        layers.clear();
        let mut views = maps.spare_views();
        for (light, candidate) in lights.iter().zip(&mut candidates) {
            let first_layer = light.slot * light.view_count;
            let state = &self.slots[light.slot as usize];
            // The map of a deferred light is sampled from the position that the light had when the
            // map was drawn.
            let (position_world, range) = if candidate.refreshed || !state.has_map {
                (light.position_world, light.range)
            } else {
                (state.position_world, state.range)
            };
            layers.extend((0..light.view_count).map(|view| LayerState {
                index: first_layer + view,
                anchor_render: (position_world - frame.origin).as_vec3(),
                range_world: f64::from(range),
                limit: range_limit(range, maps.sampling().fade),
                shadowed_texels: ALL_TEXELS,
                deferred: !candidate.refreshed,
                slice: None,
            }));
            let draws = candidate.draws.iter_mut().filter_map(Option::take);
            if candidate.refreshed {
                views.extend(draws);
                continue;
            }
            draws.for_each(|draws| maps.return_list(draws.casters));
            for view in state.views.iter().flatten() {
                if maps.holds(view) {
                    views.push(ViewDraws {
                        deferred: true,
                        ..ViewDraws::new(view.rebased(frame.origin), maps.spare_list())
                    });
                }
            }
        }
        let maps_frame = MapsFrame {
            layers: &layers,
            views,
            camera_render: frame.camera_render(),
            casters: frame.casters,
            predicted_error: None,
        };
        let report = maps.record(encoder, maps_frame)?;
        self.layers = layers;
        for (light, candidate) in lights.iter().zip(candidates.drain(..)) {
            let state = &mut self.slots[light.slot as usize];
            if candidate.refreshed {
                *state = SlotState {
                    fit: candidate.fit,
                    waited: 0,
                    has_map: true,
                    views: candidate.views,
                    position_world: light.position_world,
                    range: light.range,
                };
            } else {
                state.waited = state.waited.saturating_add(1);
            }
        }
        self.candidates = candidates;
        self.last_frame = Some(frame.version);
        self.last_lights.clear();
        self.last_lights.extend_from_slice(lights);
        Ok(report)
    }

    /// Returns whether a frame leaves all views as they are: nothing that they depend on has
    /// changed since the last frame. The time that has passed is then counted.
    fn is_as_before(&mut self, frame: &ShadowFrame<'_>, lights: &[LocalPlacement]) -> bool {
        let last_frame = self.last_frame.as_ref();
        let Some(changes) = last_frame.and_then(|last| frame.changes_since(last)) else {
            return false;
        };
        if !self.maps.is_unchanged() || self.last_lights != lights {
            return false;
        }
        self.fits.clear();
        for light in lights {
            let fit = &self.slots[light.slot as usize].fit;
            let may_change = fit.may_change(&self.input(frame, light), changes);
            let Some(fit) = (!may_change).then(|| fit.again()).flatten() else {
                return false;
            };
            self.fits.push(fit);
        }
        for (light, fit) in lights.iter().zip(self.fits.drain(..)) {
            self.slots[light.slot as usize].fit = fit;
        }
        true
    }

    /// Returns the input of the fit of a light.
    fn input<'a>(&self, frame: &ShadowFrame<'a>, light: &'a LocalPlacement) -> LocalInput<'a> {
        let maps = &self.maps;
        LocalInput {
            origin: frame.origin,
            position_world: light.position_world,
            range: f64::from(light.range),
            views: &light.axes[..light.view_count as usize],
            receiver_tangent: light.tangent,
            caster_tangent: light.tangent
                * border(maps.map_size(), maps.sampling().border_texels()),
            looks_around: maps.sampling().filter.directions().is_some(),
            seen: frame.seen,
            casters: frame.casters.casting(),
            receivers: frame.receivers,
            map_size: maps.map_size(),
            margin_texels: maps.sampling().margin_texels(),
        }
    }

    /// Fits and culls one light, and returns what would refresh it.
    fn candidate(
        &mut self,
        frame: &ShadowFrame<'_>,
        light: &LocalPlacement,
    ) -> Result<Candidate, ShadowError> {
        let input = self.input(frame, light);
        let maps = &mut self.maps;
        let axes = input.views;
        let mut drawn: [Vec<u32>; MAX_LOCAL_VIEWS] = std::array::from_fn(|_| maps.spare_list());
        let held = &self.slots[light.slot as usize].fit;
        let fit = held.fit(&input, &mut self.reached, &mut drawn);
        let mut draws = [const { None }; MAX_LOCAL_VIEWS];
        let mut views = [None; MAX_LOCAL_VIEWS];
        let mut needed = 0;
        for (index, drawn) in drawn.into_iter().enumerate() {
            let (Some(axes), Some(rect)) = (axes.get(index), &fit.rects[index]) else {
                maps.return_list(drawn);
                continue;
            };
            let layer = light.slot * light.view_count + index as u32;
            let view = PerspectiveView {
                axes,
                position_world: light.position_world,
                rect,
                near: fit.near[index],
                caster_reach: fit.caster_reach[index],
                has_symmetric_clip_depth: self.has_symmetric_clip_depth,
                reach: fit.reach,
                range: f64::from(light.range),
                cone_cosine: light.cone_cosine,
            };
            let view = ShadowView::perspective(&view, frame.origin, layer);
            let view = view.checked()?;
            let view_draws = ViewDraws::new(view, drawn);
            needed += maps.passes(&view_draws, &frame.casters);
            draws[index] = Some(view_draws);
            views[index] = Some(view);
        }
        Ok(Candidate {
            needed,
            fit,
            draws,
            views,
            refreshed: true,
        })
    }

    /// Selects the lights to refresh within a budget of `max_views` depth passes. Lights that need
    /// a refresh are taken in descending order of urgency, which is the importance times (1 + the
    /// number of frames waited), so that no light of importance above 0 waits for ever. The first
    /// is always refreshed, however small the budget; each further one is refreshed if its passes
    /// fit into the rest.
    ///
    /// The products neither overflow nor underflow in f64: a finite f32 times 2³² is far below the
    /// largest f64. An importance above 0 counts for no less than [`LEAST_SHARE_OF_IMPORTANCE`] of
    /// the frame's greatest. Among `n` lights, one of weight `w` beside a greatest weight of `W`
    /// then waits at most `(n - 1) W / w + n` frames: once its product exceeds `(n - 1) W`, only
    /// lights that have waited for at least `n - 1` frames precede it, and each of the others can
    /// do so only once.
    fn choose(&self, lights: &[LocalPlacement], max_views: u32, candidates: &mut [Candidate]) {
        let importances = lights.iter().map(|light| f64::from(light.importance));
        let least = importances.fold(0.0, f64::max) * LEAST_SHARE_OF_IMPORTANCE;
        let urgency = |index: usize| {
            let light = &lights[index];
            let weight = match f64::from(light.importance) {
                importance if importance > 0.0 => importance.max(least),
                _ => 0.0,
            };
            let waited = self.slots[light.slot as usize].waited;
            weight * (1.0 + f64::from(waited))
        };
        let mut order: Vec<usize> = (0..candidates.len())
            .filter(|&index| candidates[index].needed > 0)
            .collect();
        order.sort_by(|&a, &b| urgency(b).total_cmp(&urgency(a)));
        let mut spent = 0;
        for (rank, index) in order.into_iter().enumerate() {
            let candidate = &mut candidates[index];
            candidate.refreshed = rank == 0 || spent + candidate.needed <= max_views;
            if candidate.refreshed {
                spent += candidate.needed;
            }
        }
    }
}

/// Returns the factor by which a view of `map_size` texels is rendered wider than its receivers, so
/// that no kernel leaves the map: tan(fov/2) grows by N / (N - 2 border). At most half of a map
/// becomes border.
fn border(map_size: u32, border_texels: f64) -> f64 {
    let size = f64::from(map_size);
    size / (size - 2.0 * border_texels.min(size * 0.25))
}
