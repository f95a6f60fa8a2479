//! Determines which views need drawing this frame, and records the passes that draw them.

use crate::cast::cube_pass::{CubePass, PreparedCubePass};
use crate::cast::draw_list::DrawLists;
use crate::cast::instance_matrices::InstanceMatrices;
use crate::cast::layer_cache::{LayerCache, Plan, ViewDraws};
use crate::cast::layer_pass::{Layer, PassFrame, record_layer};
use crate::cast::shared_layer::SharedLayer;
use crate::cast::shared_layer_pass::record_shared_layer;
use crate::cast::view_uniform::ViewUniforms;
use crate::cast::{CasterPipeline, FrameCasters};
use crate::gpu::{DepthFormat, DepthMap, Upload};
use crate::{ShadowError, ShadowView};

/// Draws views into the layers of a depth map, and tracks what each layer caches.
#[derive(Debug)]
pub(crate) struct Recorder {
    label: String,
    uniforms: ViewUniforms,
    layers: Vec<Layer>,
    matrices: InstanceMatrices,
    /// Holds nothing but memory between frames.
    lists: DrawLists<'static>,
    /// Is false on wgpu's OpenGL backend, which copies no depth textures, unless views share a
    /// layer, where a draw copies them; all casters of a view are drawn again there.
    can_copy: bool,
    /// Is present where all views share one layer.
    shared_layer: Option<SharedLayer>,
    /// Is present where the layers are the faces of a cube and the device can draw them at once.
    cube: Option<CubePass>,
}

/// Tells how the views of a recorder lie in its map.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum RecorderKind {
    /// Each view has a layer of its own.
    Layers,
    /// The views are the six faces of one cube, each with a layer of its own.
    Cube,
    /// The views are rectangles of one layer of this format.
    SharedLayer(DepthFormat),
}

/// Counts what a frame recorded.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Recorded {
    pub passes: u32,
    pub draws: u32,
}

/// Holds everything that could fail, made before the encoder is touched.
pub(crate) struct PreparedViews<'a> {
    /// Replaces the pass for each view.
    cube: Option<PreparedCubePass>,
    lists: DrawLists<'a>,
}

impl Recorder {
    /// Makes a recorder for `views` views, each with a layer of its own unless they share one;
    /// `is_cube` states that they are the six faces of one cube.
    pub(crate) fn new(
        device: &wgpu::Device,
        label: &str,
        views: u32,
        kind: RecorderKind,
    ) -> Result<Self, ShadowError> {
        let uniforms = ViewUniforms::new(device, label, views)?;
        let shared_layer = match kind {
            RecorderKind::SharedLayer(format) => Some(SharedLayer::new(device, label, format)?),
            RecorderKind::Layers | RecorderKind::Cube => None,
        };
        let layers = (0..views).map(|view| Layer::new(format!("{label} view {view}")));
        Ok(Self {
            label: label.into(),
            uniforms,
            layers: layers.collect(),
            matrices: InstanceMatrices::new(device, label),
            lists: DrawLists::default(),
            can_copy: shared_layer.is_some() || device.adapter_info().backend != wgpu::Backend::Gl,
            shared_layer,
            cube: if kind == RecorderKind::Cube {
                CubePass::new(device, label)?
            } else {
                None
            },
        })
    }

    /// Returns how often `draws` needs its view rendered.
    pub(crate) fn renders(&self, draws: &ViewDraws, casters: &FrameCasters<'_>) -> u32 {
        let layer = &self.layers[draws.view.index() as usize];
        layer.cache.plan(draws, casters, self.can_copy).renders()
    }

    /// Returns whether the layer of `view` holds that view, whatever its casters.
    pub(crate) fn holds(&self, view: &ShadowView) -> bool {
        self.layers[view.index() as usize].cache.is_of(view)
    }

    /// Resets the state of a view whose texels now belong to others.
    pub(crate) fn forget(&mut self, view: u32) {
        self.layers[view as usize].cache = LayerCache::default();
    }

    /// Returns the device memory, in bytes, of the static-caster caches.
    pub(crate) fn bytes(&self) -> u64 {
        let own = self.layers.iter().filter_map(|l| l.static_cache.as_ref());
        let shared = self.shared_layer.iter().filter_map(|l| l.static_cache());
        own.chain(shared).map(DepthMap::bytes).sum()
    }

    /// Plans the frame for `map` and finds the uniforms of `views`. Each view is made to allow for
    /// the rounding of the depths that its layer will hold.
    pub(crate) fn prepare<'a>(
        &mut self,
        device: &wgpu::Device,
        map: &DepthMap,
        views: &mut [ViewDraws],
        casters: &FrameCasters<'a>,
    ) -> Result<PreparedViews<'a>, ShadowError> {
        self.matrices.clear();
        let mut lists = std::mem::take(&mut self.lists).recycled();
        let cube = self.prepare_lists(device, map, views, casters, &mut lists);
        match cube.and_then(|cube| self.matrices.prepare(device).map(|()| cube)) {
            Ok(cube) => Ok(PreparedViews { cube, lists }),
            Err(error) => {
                self.lists = lists.recycled();
                Err(error)
            }
        }
    }

    /// Adds what must be copied before the passes.
    pub(crate) fn add_uploads<'a>(
        &'a self,
        prepared: &'a PreparedViews<'_>,
        uploads: &mut Vec<Upload<'a>>,
    ) {
        uploads.extend(match (&self.cube, &prepared.cube) {
            (Some(cube), Some(prepared)) => cube.upload(prepared),
            _ => self.uniforms.upload(),
        });
        uploads.extend(self.matrices.uploads());
    }

    /// Plans all views and lists their draw calls. Returns the pass that replaces those of the six
    /// faces, if there is one.
    fn prepare_lists<'a>(
        &mut self,
        device: &wgpu::Device,
        map: &DepthMap,
        views: &mut [ViewDraws],
        casters: &FrameCasters<'a>,
        lists: &mut DrawLists<'a>,
    ) -> Result<Option<PreparedCubePass>, ShadowError> {
        self.uniforms.clear(self.layers.len());
        for draws in views.iter_mut() {
            let layer = &mut self.layers[draws.view.index() as usize];
            draws.plan = layer.cache.plan(draws, casters, self.can_copy);
            if draws.plan == Plan::RenewStaticCache {
                let has_cache = match &mut self.shared_layer {
                    Some(shared) => shared.make_static_cache(device, &layer.label, map),
                    None => layer.make_static_cache(device, map),
                };
                if !has_cache {
                    draws.plan = Plan::All;
                }
            }
            let render_reach = layer.cache.render_reach_after(draws);
            draws.view = draws.view.over_depths_from(render_reach);
            self.uniforms.set(draws.view.index(), &draws.view);
        }
        if let Some(cube) = &self.cube {
            if views.iter().all(|draws| draws.plan == Plan::All) {
                let matrices = &mut self.matrices;
                let prepared = cube.prepare(device, views, casters, lists, matrices);
                if prepared.is_some() {
                    return Ok(prepared);
                }
                lists.clear();
                self.matrices.clear();
            }
        }
        let check = |index: u32, pipeline: &CasterPipeline| {
            casters.check_pipeline(index, pipeline, device, map.format())
        };
        for draws in views {
            let cache = &self.layers[draws.view.index() as usize].cache;
            let mut add = |drawn: &mut dyn Iterator<Item = u32>| {
                lists.add(drawn, casters, &mut self.matrices, check)
            };
            let all = draws.casters.iter().copied();
            let revision = |index: u32| casters.facts(index).revision;
            let (static_calls, calls) = match draws.plan {
                Plan::Keep => (0..0, 0..0),
                Plan::All => (0..0, add(&mut all.clone())?),
                Plan::OverStaticCache => {
                    let mut moving = all.filter(|&index| !cache.is_static(revision(index)));
                    (0..0, add(&mut moving)?)
                }
                Plan::RenewStaticCache => {
                    let found = cache.static_after_renewal(draws, casters);
                    let is_static = |index: &u32| found.binary_search(&revision(*index)).is_ok();
                    (
                        add(&mut all.clone().filter(is_static))?,
                        add(&mut all.clone().filter(|index| !is_static(index)))?,
                    )
                }
            };
            (draws.static_calls, draws.calls) = (static_calls, calls);
        }
        Ok(None)
    }

    /// Records what was planned, after the uploads, and returns what that was.
    ///
    /// The state of a layer is reset before anything is drawn into it and set again when its pass
    /// is complete: a caster that panics leaves a layer behind that the next frame draws again.
    pub(crate) fn record(
        &mut self,
        encoder: &mut wgpu::CommandEncoder,
        map: &DepthMap,
        prepared: PreparedViews<'_>,
        views: &mut [ViewDraws],
        casters: &FrameCasters<'_>,
    ) -> Recorded {
        let PreparedViews {
            cube: prepared_cube,
            lists,
        } = prepared;
        if let (Some(cube), Some(prepared)) = (&mut self.cube, prepared_cube) {
            // The pass clears all layers, those of faces that nothing casts into as well.
            let mut caches: Vec<LayerCache> =
                self.layers.iter_mut().map(Layer::take_cache).collect();
            for draws in views.iter() {
                caches[draws.view.index() as usize].replace(draws, casters);
            }
            let frame = (casters, &self.matrices);
            let draws = prepared.draws();
            cube.record(encoder, map, prepared, views, &lists, frame);
            self.lists = lists.recycled();
            for draws in views.iter() {
                let index = draws.view.index() as usize;
                self.layers[index].cache = std::mem::take(&mut caches[index]);
            }
            return Recorded { passes: 1, draws };
        }
        self.uniforms.set_written();
        let frame = PassFrame {
            casters,
            matrices: &self.matrices,
            lists: &lists,
            uniforms: &self.uniforms,
            format: map.format(),
        };
        for draws in views.iter().filter(|draws| draws.plan == Plan::Keep) {
            let layer = &mut self.layers[draws.view.index() as usize];
            layer.cache.keep(draws, casters);
        }
        let drawn = views.iter_mut().filter(|draws| draws.plan != Plan::Keep);
        let passes = match &self.shared_layer {
            Some(shared) => {
                let drawn = drawn.collect();
                let shared = (shared, self.label.as_str());
                record_shared_layer(encoder, map, shared, &mut self.layers, drawn, &frame)
            }
            None => drawn
                .map(|draws| {
                    let layer = &mut self.layers[draws.view.index() as usize];
                    record_layer(encoder, map, layer, draws, &frame)
                })
                .sum(),
        };
        self.lists = lists.recycled();
        let draws = views.iter().map(ViewDraws::draw_calls);
        Recorded {
            passes,
            draws: draws.fold(0, u32::saturating_add),
        }
    }

    /// Resets the state of all layers, so that every view is drawn again.
    pub(crate) fn invalidate(&mut self) {
        for layer in &mut self.layers {
            layer.cache = LayerCache::default();
        }
        self.uniforms.invalidate();
        if let Some(cube) = &mut self.cube {
            cube.invalidate();
        }
    }
}
