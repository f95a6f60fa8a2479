//! Fits one spot or point light, and finds the draws that would refresh its views.

use glam::UVec2;

use crate::cast::ViewDraws;
use crate::fit::{LocalInput, MAX_LOCAL_VIEWS, PerspectiveView, TexelRect};
use crate::light::local::{Candidate, LocalLights, LocalPlacement};
use crate::light::pool_layer::PoolLayer;
use crate::{ShadowError, ShadowFrame, ShadowView};

/// Is the number of texels per side of a view for which the near planes of a pool are chosen, so
/// that they do not move when sizes change: that of a single light by default.
const POOL_NEAR_PLANE_TEXELS: u32 = 1024;

impl LocalLights {
    /// Returns what a light is fitted to.
    pub(super) fn input<'a>(
        &self,
        frame: &ShadowFrame<'a>,
        light: &'a LocalPlacement,
        layer: Option<&PoolLayer>,
    ) -> LocalInput<'a> {
        let maps = &self.maps;
        let first = (light.slot * light.view_count) as usize;
        let size = |view: usize| match layer {
            Some(layer) if view < light.view_count as usize => layer.side(first + view),
            _ => maps.map_size(),
        };
        let sizes_texels = std::array::from_fn(size);
        LocalInput {
            origin: frame.origin,
            position_world: light.position_world,
            range: f64::from(light.range),
            views: &light.axes[..light.view_count as usize],
            receiver_tangent: light.tangent,
            caster_tangents: sizes_texels
                .map(|size| light.tangent * border(size, maps.sampling().border_texels())),
            looks_around: maps.sampling().filter.directions().is_some(),
            seen: frame.seen,
            casters: frame.casters.casting(),
            receivers: frame.receivers,
            sizes_texels,
            near_plane_texels: match layer {
                Some(_) => POOL_NEAR_PLANE_TEXELS,
                None => maps.map_size(),
            },
            margin_texels: maps.sampling().margin_texels(),
        }
    }

    /// Fits and culls one light, and returns what would refresh it.
    pub(super) fn candidate(
        &mut self,
        frame: &ShadowFrame<'_>,
        light: &LocalPlacement,
        layer: Option<&PoolLayer>,
    ) -> Result<Candidate, ShadowError> {
        let input = self.input(frame, light, layer);
        let sizes_texels = input.sizes_texels;
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
            let number = light.slot * light.view_count + index as u32;
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
            let view = ShadowView::perspective(&view, frame.origin, number);
            let mut view = view.checked()?;
            if let Some(layer) = layer {
                // A view that has no texels of this size yet is drawn wherever it comes to be.
                let size = UVec2::splat(sizes_texels[index]);
                let nowhere = TexelRect {
                    min: UVec2::splat(u32::MAX),
                    size,
                };
                let texels = layer.texels(number as usize).unwrap_or(nowhere);
                view = view.in_shared_layer(texels, layer.map_size());
            }
            let view_draws = ViewDraws::new(view, drawn);
            needed += maps.renders(&view_draws, &frame.casters);
            draws[index] = Some(view_draws);
            views[index] = Some(view);
        }
        Ok(Candidate {
            needed,
            fit,
            draws,
            views,
            refreshed: true,
            without_room: 0,
        })
    }
}

/// Returns the factor by which a view of `map_size` texels is rendered wider than its receivers, so
/// that no kernel leaves the map: tan(fov/2) grows by N / (N - 2 border). At most half of a map
/// becomes border.
fn border(map_size: u32, border_texels: f64) -> f64 {
    let size = f64::from(map_size);
    size / (size - 2.0 * border_texels.min(size * 0.25))
}
