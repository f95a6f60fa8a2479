//! Records spot and point lights, alone or in a pool: fits their perspective views, selects those
//! that are drawn in a frame, and passes them to the maps.

use glam::DVec3;

use crate::cast::ViewDraws;
use crate::fit::{LightAxes, LocalFit, LocalNeeds, MAX_LOCAL_VIEWS, Reached};
use crate::light::distance_limit::range_limit;
use crate::light::pool_layer::PoolLayer;
use crate::light::scene::FrameVersion;
use crate::receive::{ALL_TEXELS, LayerState, MapsFrame, ShadowMaps, ShadowMapsDescriptor};
use crate::{ShadowError, ShadowFrame, ShadowView, report::ShadowReport};

/// Holds spot or point lights in the slots of one set of maps. A single light has one slot; a pool
/// has as many as its capacity.
#[derive(Debug)]
pub(crate) struct LocalLights {
    pub(super) maps: ShadowMaps,
    /// Divides the layer of a pool; `None` for a single light, whose views have layers of their
    /// own.
    pool_layer: Option<PoolLayer>,
    pub(super) slots: Vec<SlotState>,
    /// States that the device clips depth to -1..1.
    pub(super) has_symmetric_clip_depth: bool,
    /// Is empty between frames; this list and the next are reused for their memory.
    candidates: Vec<Candidate>,
    layers: Vec<LayerState>,
    pub(super) reached: Reached,
    pub(super) needs: LocalNeeds,
    /// Is what the maps were last recorded for, with the list after this.
    last_frame: Option<FrameVersion>,
    last_lights: Vec<LocalPlacement>,
    /// Is reused from frame to frame for its memory.
    fits: Vec<LocalFit>,
}

#[derive(Clone, Debug, Default)]
pub(super) struct SlotState {
    pub fit: LocalFit,
    /// Counts the frames for which a needed refresh has been deferred.
    pub waited: u32,
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

/// Holds the new fit of a light and the draws that would refresh it.
#[derive(Debug)]
pub(super) struct Candidate {
    pub fit: LocalFit,
    pub draws: [Option<ViewDraws>; MAX_LOCAL_VIEWS],
    /// Holds the views of `draws`.
    pub views: [Option<ShadowView>; MAX_LOCAL_VIEWS],
    /// Counts how often its views need to be rendered.
    pub needed: u32,
    pub refreshed: bool,
    /// Has a bit for each view for which there is no room in the layer.
    pub without_room: u32,
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

impl LocalPlacement {
    /// Returns the number of one of its views among those of all lights.
    pub(crate) fn view(&self, view: usize) -> usize {
        (self.slot * self.view_count) as usize + view
    }
}

impl LocalLights {
    /// Makes the maps, and a slot for each of their lights.
    pub(super) fn new(
        device: &wgpu::Device,
        descriptor: &ShadowMapsDescriptor<'_>,
    ) -> Result<Self, ShadowError> {
        let maps = ShadowMaps::new(device, descriptor)?;
        let views = descriptor.lights * descriptor.views_per_light;
        let pool_layer = if descriptor.shares_layer {
            let layer = PoolLayer::new(descriptor.map_size, views as usize);
            Some(layer.ok_or_else(|| ShadowError::OutOfRange {
                field: descriptor.size_field,
                rule: "large enough for one texel per view in a square of 2^n times 2^n views",
                value: descriptor.map_size.to_string(),
            })?)
        } else {
            None
        };
        Ok(Self {
            maps,
            pool_layer,
            has_symmetric_clip_depth: device.adapter_info().backend == wgpu::Backend::Gl,
            slots: vec![SlotState::default(); descriptor.lights as usize],
            candidates: Vec::new(),
            layers: Vec::new(),
            reached: Reached::default(),
            needs: LocalNeeds::default(),
            last_frame: None,
            last_lights: Vec::new(),
            fits: Vec::new(),
        })
    }

    /// Returns the maps of all lights.
    pub(super) fn maps(&self) -> &ShadowMaps {
        &self.maps
    }

    /// Declares the contents of the maps invalid, so that the next frame draws every view.
    pub(super) fn invalidate(&mut self) {
        self.maps.invalidate();
    }

    /// Discards the extents of earlier frames.
    pub(super) fn reset_history(&mut self) {
        self.last_frame = None;
        for slot in &mut self.slots {
            slot.fit = LocalFit::default();
        }
        if let Some(layer) = &mut self.pool_layer {
            layer.reset_history();
        }
    }

    /// Resets the state of a slot, whose next light then has no map until it is drawn.
    pub(super) fn reset(&mut self, slot: u32) {
        self.last_frame = None;
        self.slots[slot as usize] = SlotState::default();
        if let Some(layer) = &mut self.pool_layer {
            let count = self.maps.views_per_light();
            for view in slot * count..(slot + 1) * count {
                layer.release(view as usize);
                self.maps.forget(view);
            }
        }
    }

    /// Fits and culls `lights`, uploads their uniforms and records their depth passes. `max_views`
    /// is the largest number of views to render; `None` sets no limit.
    pub(super) fn record(
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
        // Until nothing can fail any longer, the changes are those of a copy.
        let mut pool_layer = self.pool_layer.clone();
        for light in lights {
            candidates.push(self.candidate(frame, light, pool_layer.as_ref())?);
        }
        let mut given_up = Vec::new();
        if let Some(layer) = &mut pool_layer {
            self.find_sizes(frame, lights, layer, &mut candidates)?;
        }
        let spent = max_views.map(|max_views| {
            let spent = self.choose(lights, max_views, &mut candidates);
            max_views.saturating_sub(spent)
        });
        if let Some(layer) = &mut pool_layer {
            given_up = self.place(frame, lights, layer, spent, &mut candidates)?;
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
                deferred: !candidate.refreshed || candidate.without_room >> view & 1 == 1,
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
            predicted_error: pool_layer
                .as_ref()
                .and_then(|layer| layer.predicted_error)
                .map(|error| error as f32),
        };
        maps.record(encoder, maps_frame)?;
        given_up
            .into_iter()
            .for_each(|view| maps.forget(view as u32));
        self.pool_layer = pool_layer;
        self.layers = layers;
        let lacks_room = candidates
            .iter()
            .any(|candidate| candidate.without_room > 0);
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
        // A view without room finds some as soon as others have moved.
        self.last_frame = (!lacks_room).then_some(frame.version);
        self.last_lights.clear();
        self.last_lights.extend_from_slice(lights);
        Ok(self.maps.report())
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
        let is_same_frame = changes.is_empty();
        let layer = self.pool_layer.as_ref();
        if layer.is_some_and(|layer| !layer.keeps_sizes(is_same_frame)) {
            return false;
        }
        self.fits.clear();
        for light in lights {
            let fit = &self.slots[light.slot as usize].fit;
            let may_change = fit.may_change(&self.input(frame, light, layer), changes);
            let Some(fit) = (!may_change).then(|| fit.again()).flatten() else {
                return false;
            };
            self.fits.push(fit);
        }
        for (light, fit) in lights.iter().zip(self.fits.drain(..)) {
            self.slots[light.slot as usize].fit = fit;
        }
        if let Some(layer) = &mut self.pool_layer {
            layer.keep_sizes(is_same_frame);
        }
        true
    }
}
