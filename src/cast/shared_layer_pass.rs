//! Records the depth passes over a layer that several views share: one for all the views that a
//! frame draws. Each pass that keeps what is in a layer loads and stores the whole of it on a GPU
//! that renders in tiles.

use std::ops::Range;

use crate::cast::CLEAR;
use crate::cast::layer_cache::{LayerCache, Plan, ViewDraws};
use crate::cast::layer_pass::{Layer, PassFrame, begin_pass};
use crate::cast::shared_layer::SharedLayer;
use crate::gpu::DepthMap;

/// States what the rectangle of a view holds before its casters are drawn.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Before {
    /// It holds the far plane already.
    Cleared,
    /// It is cleared by a draw.
    Clear,
    /// The static casters are copied into it by a draw.
    StaticCasters,
}

/// Records the passes of the views `drawn`, and returns their number: one over the map, and one
/// over the static-caster cache if any view renews its part of that. The states of the views are
/// set when both are complete.
pub(super) fn record_shared_layer(
    encoder: &mut wgpu::CommandEncoder,
    map: &DepthMap,
    (shared, label): (&SharedLayer, &str),
    layers: &mut [Layer],
    mut drawn: Vec<&mut ViewDraws>,
    frame: &PassFrame<'_, '_>,
) -> u32 {
    if drawn.is_empty() {
        return 0;
    }
    let mut caches: Vec<LayerCache> = Vec::with_capacity(drawn.len());
    for draws in &mut drawn {
        let mut cache = layers[draws.view.index() as usize].take_cache();
        cache.replace(draws, frame.casters);
        if draws.plan == Plan::OverStaticCache {
            frame.count_copied(draws, &cache);
        }
        caches.push(cache);
    }
    let label_of = |draws: &ViewDraws| layers[draws.view.index() as usize].label.as_str();
    let mut passes = 0;
    if let Some(static_cache) = shared.static_cache() {
        let mut renewed = drawn
            .iter()
            .filter(|draws| draws.plan == Plan::RenewStaticCache)
            .peekable();
        if renewed.peek().is_some() {
            let target = static_cache.layer_view(0);
            let mut into = begin_pass(encoder, label, target, wgpu::LoadOp::Load);
            for draws in renewed {
                let shared = (shared, label_of(draws));
                let calls = (Before::Clear, &draws.static_calls);
                draw_view(&mut into, shared, frame, draws, calls);
            }
            passes += 1;
        }
    }
    let draws_all = drawn.iter().all(|draws| draws.plan == Plan::All);
    // What no view relies on need not be kept: the states of the views drawn are taken already.
    let is_free = draws_all && layers.iter().all(|layer| layer.cache.is_empty());
    let (load, cleared) = if is_free {
        (CLEAR, Before::Cleared)
    } else {
        (wgpu::LoadOp::Load, Before::Clear)
    };
    let mut into = begin_pass(encoder, label, map.layer_view(0), load);
    for draws in &drawn {
        let before = match draws.plan {
            Plan::All | Plan::Keep => cleared,
            Plan::OverStaticCache | Plan::RenewStaticCache => Before::StaticCasters,
        };
        let shared = (shared, label_of(draws));
        draw_view(&mut into, shared, frame, draws, (before, &draws.calls));
    }
    drop(into);
    for (draws, cache) in drawn.iter().zip(caches) {
        layers[draws.view.index() as usize].cache = cache;
    }
    passes + 1
}

/// Draws a view into a pass over the layer: makes the listed `calls` in its rectangle.
fn draw_view(
    pass: &mut wgpu::RenderPass<'_>,
    (shared, label): (&SharedLayer, &str),
    frame: &PassFrame<'_, '_>,
    draws: &ViewDraws,
    (before, calls): (Before, &Range<usize>),
) {
    pass.push_debug_group(label);
    frame.defaults(&draws.view).set_rect(pass);
    match before {
        Before::Cleared => {}
        Before::Clear => shared.clear(pass),
        Before::StaticCasters => shared.copy_static_casters(pass),
    }
    frame.draw(pass, &draws.view, calls);
    pass.pop_debug_group();
}
