//! What spot and point lights share, alone or in a pool: the fit of their perspective views, the choice of which are drawn in
//! a frame, and the way to the maps.

use glam::DVec3;

use crate::cast::ViewDraws;
use crate::fit::{LightAxes, LocalFit, LocalInput, MAX_LOCAL_VIEWS, PerspectiveView, Reached};
use crate::receive::{LayerState, MapsFrame, ShadowMaps};
use crate::{ShadowError, ShadowFrame, ShadowView, report::ShadowReport};

/// State of the lights in the slots of one set of maps.
#[derive(Debug)]
pub(crate) struct LocalLights {
    slots: Vec<SlotState>,
    /// The device clips depth to -1..1.
    has_symmetric_clip_depth: bool,
    /// Empty between frames; kept for their memory.
    candidates: Vec<Candidate>,
    layers: Vec<LayerState>,
    reached: Reached,
}

#[derive(Clone, Debug, Default)]
struct SlotState {
    fit: LocalFit,
    /// Frames for which a needed refresh has been put off.
    waited: u32,
    /// Its layers have been drawn, or found to need nothing, since it came.
    has_map: bool,
    /// What was put into them then.
    views: [Option<ShadowView>; MAX_LOCAL_VIEWS],
    /// Where it stood then.
    position_world: DVec3,
    /// How far it shone then.
    range: f32,
}

/// A light of a frame.
#[derive(Debug)]
pub(crate) struct LocalPlacement {
    pub slot: u32,
    pub position_world: DVec3,
    pub range: f32,
    /// Axes of its views; the first `view_count` count.
    pub axes: [LightAxes; MAX_LOCAL_VIEWS],
    pub view_count: u32,
    /// Tangent of half the angle of a view, without border.
    pub tangent: f64,
    pub cone_cosine: f64,
    /// Who is refreshed first.
    pub importance: f32,
}

/// A light's new fit and what it would draw.
#[derive(Debug)]
struct Candidate {
    fit: LocalFit,
    draws: [Option<ViewDraws>; MAX_LOCAL_VIEWS],
    /// The views of `draws`.
    views: [Option<ShadowView>; MAX_LOCAL_VIEWS],
    /// Depth passes that its views need.
    needed: u32,
    refreshed: bool,
}

/// What a light of importance above 0 counts for at least, as a share of the most important one of the frame.
const LEAST_SHARE_OF_IMPORTANCE: f64 = 1.0 / 4096.0;

impl LocalLights {
    /// For `capacity` lights of a device.
    pub fn new(device: &wgpu::Device, capacity: u32) -> Self {
        Self {
            has_symmetric_clip_depth: device.adapter_info().backend == wgpu::Backend::Gl,
            slots: vec![SlotState::default(); capacity as usize],
            candidates: Vec::new(),
            layers: Vec::new(),
            reached: Reached::default(),
        }
    }

    /// Forgets the light of a slot.
    pub fn reset(&mut self, slot: u32) {
        self.slots[slot as usize] = SlotState::default();
    }

    /// Fits, culls, uploads and records into `maps`.
    pub fn record<'m>(
        &mut self,
        maps: &'m mut ShadowMaps,
        encoder: &mut wgpu::CommandEncoder,
        frame: &ShadowFrame<'_>,
        lights: &[LocalPlacement],
        max_views: Option<u32>,
    ) -> Result<&'m ShadowReport, ShadowError> {
        let mut candidates = std::mem::take(&mut self.candidates);
        candidates.clear();
        for light in lights {
            candidates.push(self.candidate(maps, frame, light)?);
        }
        if let Some(max_views) = max_views {
            self.choose(lights, max_views, &mut candidates);
        }

        let mut layers = std::mem::take(&mut self.layers);
        layers.clear();
        let mut views = maps.spare_views();
        for (light, candidate) in lights.iter().zip(&mut candidates) {
            let first_layer = light.slot * light.view_count;
            let state = &self.slots[light.slot as usize];
            // A light that is put off is asked where it stood when its map was drawn.
            let (position_world, range) = if candidate.refreshed || !state.has_map {
                (light.position_world, light.range)
            } else {
                (state.position_world, state.range)
            };
            layers.extend((0..light.view_count).map(|view| LayerState {
                layer: first_layer + view,
                anchor_render: (position_world - frame.origin).as_vec3(),
                range_world: f64::from(range),
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
            viewer_render: frame.viewer_render(),
            casters: frame.casters,
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
        Ok(report)
    }

    /// Fits and culls one light.
    fn candidate(
        &mut self,
        maps: &mut ShadowMaps,
        frame: &ShadowFrame<'_>,
        light: &LocalPlacement,
    ) -> Result<Candidate, ShadowError> {
        let axes = &light.axes[..light.view_count as usize];
        let input = LocalInput {
            origin: frame.origin,
            position_world: light.position_world,
            range: f64::from(light.range),
            views: axes,
            receiver_tangent: light.tangent,
            caster_tangent: light.tangent
                * border(maps.map_size(), maps.sampling().border_texels()),
            looks_around: maps.sampling().filter.directions().is_some(),
            seen: frame.seen,
            casters: frame.casters.bounds,
            receivers: frame.receivers,
            map_size: maps.map_size(),
            margin_texels: maps.sampling().margin_texels(),
        };
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

    /// Spends the budget: lights in need of a refresh by importance times the frames they have waited, so that none starves.
    /// The first is always refreshed, however small the budget.
    ///
    /// In f64 no product overflows or vanishes: a finite f32 times 2³² is far below the largest f64. An importance above 0
    /// counts for no less than a share of the frame's greatest. With `n` lights, the one of weight `w` beside a greatest of `W`
    /// then waits at most `(n - 1) W / w + n` frames: once its product exceeds `(n - 1) W`, only those go before it that have
    /// waited for `n - 1` frames, and that is each of the others once.
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

/// How much wider than its receivers a view of `map_size` texels is rendered, so that no kernel leaves it: tan(fov/2) grows by
/// N / (N - 2 border). A map smaller than its borders keeps its middle half.
fn border(map_size: u32, border_texels: f64) -> f64 {
    let size = f64::from(map_size);
    size / (size - 2.0 * border_texels.min(size * 0.25))
}
