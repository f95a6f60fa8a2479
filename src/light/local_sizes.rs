//! Chooses the sizes of the views of a pool's lights, and gives them their texels.

use crate::fit::{LightShape, Region};
use crate::light::local::{Candidate, LocalLights, LocalPlacement};
use crate::light::pool_layer::{PoolLayer, Request};
use crate::{ShadowError, ShadowFrame};

impl LocalLights {
    /// Chooses the sizes of the views of a pool where that is due, and fits the lights anew whose
    /// views change.
    pub(super) fn find_sizes(
        &mut self,
        frame: &ShadowFrame<'_>,
        lights: &[LocalPlacement],
        layer: &mut PoolLayer,
        candidates: &mut [Candidate],
    ) -> Result<(), ShadowError> {
        let is_new = |(light, candidate): (&LocalPlacement, &Candidate)| {
            let views = (0..).zip(&candidate.draws);
            let mut drawn = views.filter(|(_, draws)| draws.is_some());
            drawn.any(|(view, _)| layer.is_new(light.view(view)))
        };
        let has_new = lights.iter().zip(candidates.iter()).any(is_new);
        if !(layer.count_frame() | has_new) {
            return Ok(());
        }
        let cameras = match frame.region {
            Region::Cameras(cameras) if !cameras.is_empty() => Some(cameras),
            _ => None,
        };
        if let Some(cameras) = cameras {
            self.needs.look(cameras, frame.receivers);
        }
        let mut seen = vec![None; self.slots.len() * self.maps.views_per_light() as usize];
        for (light, candidate) in lights.iter().zip(candidates.iter()) {
            let mut needs = Default::default();
            let (position, range) = (light.position_world - frame.origin, light.range.into());
            let counts = cameras.is_some() && candidate.draws.iter().any(Option::is_some);
            if counts && self.needs.any_within(position, range) {
                let input = self.input(frame, light, Some(layer));
                self.reached.find(&input, position, candidate.fit.reach);
                let shape = LightShape {
                    position,
                    range,
                    views: input.views,
                    tangent: light.tangent,
                    cone_cosine: light.cone_cosine,
                };
                needs = self.needs.of(&shape, &self.reached.casters);
            }
            for (view, need) in needs.into_iter().enumerate() {
                if let Some(size) = candidate.fit.needed_size(view) {
                    seen[light.view(view)] = Some((0.5 * size.element_sum(), need));
                }
            }
        }
        let before = layer.clone();
        layer.choose(&seen, cameras.is_some(), self.needs.points());
        for (light, candidate) in lights.iter().zip(candidates) {
            let changes = |view| before.side(light.view(view)) != layer.side(light.view(view));
            if (0..light.view_count as usize).any(changes) {
                self.fit_anew(frame, light, layer, candidate)?;
            }
        }
        Ok(())
    }

    /// Fits a light of a pool to the sizes of its views.
    fn fit_anew(
        &mut self,
        frame: &ShadowFrame<'_>,
        light: &LocalPlacement,
        layer: &PoolLayer,
        candidate: &mut Candidate,
    ) -> Result<(), ShadowError> {
        let next = self.candidate(frame, light, Some(layer))?;
        let before = std::mem::replace(candidate, next);
        candidate.refreshed = before.refreshed;
        let draws = before.draws.into_iter().flatten();
        draws.for_each(|draws| self.maps.return_list(draws.casters));
        Ok(())
    }

    /// Gives the views of refreshed lights their texels, and returns the views that have lost
    /// theirs. `spare` is the number of views that may still be rendered because they have to move.
    pub(super) fn place(
        &mut self,
        frame: &ShadowFrame<'_>,
        lights: &[LocalPlacement],
        layer: &mut PoolLayer,
        spare: Option<u32>,
        candidates: &mut [Candidate],
    ) -> Result<Vec<usize>, ShadowError> {
        let requests = lights.iter().zip(candidates.iter());
        let requests: Vec<Request> = requests
            .flat_map(|(light, candidate)| {
                (0..light.view_count as usize).map(|view| Request {
                    view: light.view(view),
                    draws: candidate.draws[view].is_some(),
                    refreshed: candidate.refreshed,
                })
            })
            .collect();
        let placed = layer.place(&requests, spare);
        for (light, candidate) in lights.iter().zip(candidates) {
            let interim = |view| placed.interim.contains(&light.view(view));
            if (0..light.view_count as usize).any(interim) {
                self.fit_anew(frame, light, layer, candidate)?;
            }
            for view in 0..light.view_count as usize {
                let Some(draws) = candidate.draws[view].as_mut() else {
                    continue;
                };
                match layer.texels(light.view(view)) {
                    Some(texels) => {
                        draws.view = draws.view.in_shared_layer(texels, layer.map_size());
                        candidate.views[view] = Some(draws.view);
                    }
                    None if candidate.refreshed => {
                        if let Some(draws) = candidate.draws[view].take() {
                            self.maps.return_list(draws.casters);
                        }
                        candidate.views[view] = None;
                        candidate.without_room |= 1 << view;
                    }
                    None => {}
                }
            }
        }
        Ok(placed.given_up)
    }
}
