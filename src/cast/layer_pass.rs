//! Records the depth passes over a layer that belongs to one view.

use std::ops::Range;

use crate::ShadowView;
use crate::cast::draw_casters::{DrawContext, PassDefaults, draw_casters};
use crate::cast::draw_list::DrawLists;
use crate::cast::instance_matrices::InstanceMatrices;
use crate::cast::layer_cache::{LayerCache, Plan, ViewDraws};
use crate::cast::view_uniform::ViewUniforms;
use crate::cast::{CLEAR, FrameCasters, depth_attachment};
use crate::gpu::{DepthFormat, DepthMap};

/// Holds what a recorder has for each of its views.
#[derive(Debug)]
pub(super) struct Layer {
    pub label: String,
    pub cache: LayerCache,
    /// Is the static-caster cache, a texture of one layer; `None` before its first use, and where
    /// views share a layer, which has one for all.
    pub static_cache: Option<DepthMap>,
    /// States that the device could not make one.
    static_cache_failed: bool,
}

/// Holds what the passes of a frame have in common.
pub(super) struct PassFrame<'a, 'c> {
    pub casters: &'a FrameCasters<'c>,
    pub matrices: &'a InstanceMatrices,
    pub lists: &'a DrawLists<'c>,
    /// Is bind group 0.
    pub uniforms: &'a ViewUniforms,
    pub format: DepthFormat,
}

impl Layer {
    pub(super) fn new(label: String) -> Self {
        Self {
            label,
            cache: LayerCache::default(),
            static_cache: None,
            static_cache_failed: false,
        }
    }

    /// Takes the state of the layer and leaves an empty one, under which no depths in the layer are
    /// relied on.
    pub(super) fn take_cache(&mut self) -> LayerCache {
        std::mem::take(&mut self.cache)
    }

    /// Makes the static-caster cache of the layer if it has none. Returns false where the device
    /// could not make one; all casters are then drawn.
    pub(super) fn make_static_cache(&mut self, device: &wgpu::Device, map: &DepthMap) -> bool {
        if self.static_cache.is_none() && !self.static_cache_failed {
            let label = format!("{} static casters", self.label);
            self.static_cache =
                DepthMap::new(device, &label, "map_size", map.size(), 1, map.format()).ok();
            self.static_cache_failed = self.static_cache.is_none();
        }
        self.static_cache.is_some()
    }
}

impl PassFrame<'_, '_> {
    /// Returns the state of a pass that the casters of a view rely on.
    pub(super) fn defaults(&self, view: &ShadowView) -> PassDefaults<'_> {
        let (view_group, offset) = self.uniforms.group(view.index());
        PassDefaults {
            view_group,
            offset: Some(offset),
            texels: view.texels(),
        }
    }

    /// Draws the calls of a view that are listed under `calls`. The viewport and scissor rectangle
    /// of the pass are those of the view.
    pub(super) fn draw(
        &self,
        pass: &mut wgpu::RenderPass<'_>,
        view: &ShadowView,
        calls: &Range<usize>,
    ) {
        let defaults = self.defaults(view);
        let calls = self.lists.calls(calls.clone());
        let context = DrawContext {
            casters: self.casters,
            matrices: self.matrices,
            view,
        };
        // The planning of the frame has checked that there is a pipeline for the format.
        draw_casters(pass, &defaults, &context, calls, |pipeline| {
            pipeline.wgpu_pipeline(self.format)
        });
    }

    /// Counts the casters of a view that come from its static-caster cache.
    pub(super) fn count_copied(&self, draws: &mut ViewDraws, cache: &LayerCache) {
        let drawn = draws.casters.iter();
        let facts = drawn.map(|&caster| self.casters.facts(caster));
        for facts in facts.filter(|facts| cache.is_static(facts.revision)) {
            draws.copied += 1;
            draws.copied_triangles += u64::from(facts.triangles);
        }
    }
}

/// Begins a depth pass over `target`.
pub(super) fn begin_pass<'e>(
    encoder: &'e mut wgpu::CommandEncoder,
    label: &str,
    target: &wgpu::TextureView,
    load: wgpu::LoadOp<f32>,
) -> wgpu::RenderPass<'e> {
    encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        label: Some(label),
        color_attachments: &[],
        depth_stencil_attachment: Some(depth_attachment(target, load)),
        timestamp_writes: None,
        occlusion_query_set: None,
        multiview_mask: None,
    })
}

/// Records the passes of a view that has `layer` to itself, and returns their number. The state of
/// the layer is set when all of them are complete.
pub(super) fn record_layer(
    encoder: &mut wgpu::CommandEncoder,
    map: &DepthMap,
    layer: &mut Layer,
    draws: &mut ViewDraws,
    frame: &PassFrame<'_, '_>,
) -> u32 {
    let mut cache = layer.take_cache();
    cache.replace(draws, frame.casters);
    let mut load = CLEAR;
    if let Some(static_cache) = layer
        .static_cache
        .as_ref()
        .filter(|_| draws.plan != Plan::All)
    {
        if draws.plan == Plan::RenewStaticCache {
            let mut pass = begin_pass(encoder, &layer.label, static_cache.layer_view(0), CLEAR);
            frame.draw(&mut pass, &draws.view, &draws.static_calls);
        } else {
            frame.count_copied(draws, &cache);
        }
        encoder.copy_texture_to_texture(
            static_cache.layer_copy(0),
            map.layer_copy(draws.view.layer()),
            map.layer_extent(),
        );
        load = wgpu::LoadOp::Load;
    }
    let target = map.layer_view(draws.view.layer());
    let mut pass = begin_pass(encoder, &layer.label, target, load);
    frame.draw(&mut pass, &draws.view, &draws.calls);
    drop(pass);
    layer.cache = cache;
    draws.plan.renders()
}
