//! Defines what every light owns: a depth map, the recorder that fills it, the uniforms of its
//! views, and a report.

use glam::Vec3;

use crate::cast::{FrameCasters, Plan, Recorder, RecorderKind, ViewDraws};
use crate::error::DeviceError;
use crate::gpu::{DepthMap, StagedUploads, UploadBuffer, capture_device_errors};
use crate::receive::layer_limits::check_layers;
use crate::receive::layer_state::LayerState;
use crate::receive::light_uniforms::{LightUniforms, empty_view_uniform, lights};
use crate::receive::report::{ShadowReport, ViewReport, ViewStatus};
use crate::receive::sampled_maps::{SampledMaps, Selection};
use crate::receive::{Sampling, ShadowViewUniform, view_uniform_bytes};
use crate::{ShadowError, ShadowView};

/// Holds what shaders sample of a light: its depth texture and its uniform buffer, with the
/// settings that determine how they are sampled.
///
/// A light's `maps` method returns it. It is passed unchanged to
/// [`ShadowBindings`](crate::ShadowBindings) and [`DebugView`](crate::debug::DebugView); the
/// methods that return its parts are meant for engines with their own bind groups. Texture and
/// buffer stay the same for the whole lifetime of the light, so a bind group remains valid in all
/// frames.
#[derive(Debug)]
pub struct ShadowMaps {
    device: wgpu::Device,
    map: DepthMap,
    recorder: Recorder,
    uniforms: UploadBuffer,
    sampling: Sampling,
    selection: Selection,
    views_per_light: u32,
    view_count: u32,
    /// States that all views are rectangles of the first layer.
    shares_layer: bool,
    indexed: bool,
    views: Vec<ViewDraws>,
    uniform_values: Vec<ShadowViewUniform>,
    report: ShadowReport,
    /// States that the last frame left all views as they were, so that an equal frame does the
    /// same.
    is_unchanged: bool,
    memory: Memory,
}

/// Holds lists that are reused from frame to frame for their memory alone.
#[derive(Debug, Default)]
struct Memory {
    casters: Vec<Vec<u32>>,
    views: Vec<ViewDraws>,
    uniforms: Vec<ShadowViewUniform>,
}

/// Describes what a light's maps are made of.
pub(crate) struct ShadowMapsDescriptor<'a> {
    pub label: &'a str,
    /// Is the path of the size in the caller's descriptor, for errors.
    pub size_field: &'static str,
    pub map_size: u32,
    /// Is the number of lights: one, or the capacity of a pool.
    pub lights: u32,
    pub views_per_light: u32,
    /// Names what determines the number of layers, for the error of a device that cannot hold so
    /// many.
    pub layers_field: &'static str,
    pub sampling: Sampling,
    pub selection: Selection,
    /// States that all views are rectangles of one layer.
    pub shares_layer: bool,
    /// States that the maps are those of a pool, whose WGSL function takes the index of a light.
    pub indexed: bool,
}

/// Holds the input of a frame for the maps.
pub(crate) struct MapsFrame<'a> {
    /// Describes the views of this frame's lights; all other views are lit and not reported.
    pub layers: &'a [LayerState],
    /// Holds the views into which something casts, in the order of `layers`; the other layers are
    /// lit.
    pub views: Vec<ViewDraws>,
    /// Is the position of the first camera, if there is one.
    pub camera_render: Option<Vec3>,
    pub casters: FrameCasters<'a>,
    /// Is the error that was predicted for the layout of the views.
    pub predicted_error: Option<f32>,
}

impl ShadowMaps {
    /// Creates the maps, which are lit everywhere until the first frame is recorded.
    pub(crate) fn new(
        device: &wgpu::Device,
        descriptor: &ShadowMapsDescriptor<'_>,
    ) -> Result<Self, ShadowError> {
        // Every product fits in 64 bits. A number of layers that a device can hold also fits in 32
        // bits.
        let views = u64::from(descriptor.lights) * u64::from(descriptor.views_per_light);
        let layers = if descriptor.shares_layer { 1 } else { views };
        let shares_layer = descriptor.shares_layer;
        check_layers(device, descriptor.layers_field, shares_layer, views)?;
        let (label, views, layers) = (descriptor.label, views as u32, layers as u32);
        let map = DepthMap::new(
            device,
            label,
            descriptor.size_field,
            descriptor.map_size,
            layers,
            descriptor.sampling.depth_format,
        )?;
        let report = ShadowReport {
            bytes_held: map.bytes(),
            ..ShadowReport::default()
        };
        Ok(Self {
            device: device.clone(),
            map,
            recorder: Recorder::new(
                device,
                label,
                views,
                if descriptor.shares_layer {
                    RecorderKind::SharedLayer(descriptor.sampling.depth_format)
                } else if descriptor.selection == Selection::CubeFace && !descriptor.indexed {
                    RecorderKind::Cube
                } else {
                    RecorderKind::Layers
                },
            )?,
            uniforms: UploadBuffer::new(
                device,
                &format!("{label} views"),
                view_uniform_bytes(views.into()),
            )?,
            sampling: descriptor.sampling,
            selection: descriptor.selection,
            views_per_light: descriptor.views_per_light,
            view_count: views,
            shares_layer: descriptor.shares_layer,
            indexed: descriptor.indexed,
            views: Vec::new(),
            uniform_values: vec![empty_view_uniform(0, Vec3::ZERO, f64::INFINITY); views as usize],
            report,
            is_unchanged: false,
            memory: Memory::default(),
        })
    }

    pub(crate) fn sampling(&self) -> &Sampling {
        &self.sampling
    }

    /// Returns the depth texture. Its depths are reversed: near 1, far 0. Its format is
    /// `Depth32Float`, or that of a directional light's [`DepthFormat`](crate::DepthFormat). It has
    /// one layer per cascade, spot light or cube face (+x, -x, +y, -y, +z, -z), and a single layer
    /// under [`CascadeLayout::Automatic`](crate::CascadeLayout::Automatic) and for a pool. It can
    /// be copied from on all backends but OpenGL.
    pub fn texture(&self) -> &wgpu::Texture {
        self.map.texture()
    }

    /// Returns a view of all layers, to be bound as a `texture_depth_2d_array`. Where shaders
    /// cannot gather (OpenGL ES 3.0, WebGL 2), bind it as a `texture_2d_array<f32>` for all filters
    /// but [`Filter::Hardware`](crate::Filter::Hardware).
    pub fn texture_view(&self) -> &wgpu::TextureView {
        self.map.array_view()
    }

    pub(crate) fn views_per_light(&self) -> u32 {
        self.views_per_light
    }

    pub(crate) fn map_size(&self) -> u32 {
        self.map.size()
    }

    /// Returns the uniform buffer, which holds one [`ShadowViewUniform`] per view, that is per
    /// layer unless views share one.
    pub fn uniform_buffer(&self) -> &wgpu::Buffer {
        self.uniforms.buffer()
    }

    /// Returns the uniforms of the last frame, one per view: what the uniform buffer holds.
    pub fn view_uniforms(&self) -> &[ShadowViewUniform] {
        &self.uniform_values
    }

    /// Returns the views of the last frame, in the order of the frame's lights and of the layers of
    /// each. Views into which nothing casts are omitted. [`ShadowView::layer`] tells which layer
    /// each view is rendered into.
    pub fn views(&self) -> impl ExactSizeIterator<Item = &ShadowView> {
        self.views.iter().map(|draws| &draws.view)
    }

    /// Returns what the light did in the last frame.
    pub fn report(&self) -> &ShadowReport {
        &self.report
    }

    /// Returns what a lookup needs to know of the maps.
    pub(crate) fn sampled(&self) -> SampledMaps<'_> {
        SampledMaps {
            map: self.map.array_view(),
            views: self.uniforms.buffer(),
            view_count: self.view_count,
            uniforms: &self.uniform_values,
            sampling: self.sampling,
            selection: self.selection,
            views_per_light: self.views_per_light,
            shares_layer: self.shares_layer,
            indexed: self.indexed,
        }
    }

    /// Returns the device that the maps are on.
    pub(crate) fn device(&self) -> &wgpu::Device {
        &self.device
    }

    /// Resets the state of all layers and of the uniform buffer, so that the next frame draws and
    /// uploads everything.
    pub(crate) fn invalidate(&mut self) {
        self.is_unchanged = false;
        self.recorder.invalidate();
        self.uniforms.invalidate();
    }

    /// Resets the state of a view whose texels now belong to others.
    pub(crate) fn forget(&mut self, view: u32) {
        self.recorder.forget(view);
    }

    /// Returns an empty list of caster indices, which reuses the memory of an earlier frame.
    pub(crate) fn spare_list(&mut self) -> Vec<u32> {
        let mut list = self.memory.casters.pop().unwrap_or_default();
        list.clear();
        list
    }

    /// Takes back a list that no view needed.
    pub(crate) fn return_list(&mut self, list: Vec<u32>) {
        self.memory.casters.push(list);
    }

    /// Returns an empty list of views, which reuses the memory of an earlier frame.
    pub(crate) fn spare_views(&mut self) -> Vec<ViewDraws> {
        std::mem::take(&mut self.memory.views)
    }

    /// Uploads the uniforms of a frame and records its depth passes. If it returns an error,
    /// nothing has been recorded and nothing has changed.
    pub(crate) fn record(
        &mut self,
        encoder: &mut wgpu::CommandEncoder,
        frame: MapsFrame<'_>,
    ) -> Result<&ShadowReport, ShadowError> {
        let MapsFrame {
            layers,
            mut views,
            camera_render,
            casters,
            predicted_error,
        } = frame;
        self.is_unchanged = false;
        let device = &self.device.clone();
        let prepared = self
            .recorder
            .prepare(device, &self.map, &mut views, &casters)?;
        let uniform_values = self.uniforms_of(layers, &views, camera_render);
        let uniform_bytes = bytemuck::cast_slice(&uniform_values);
        let mut uploads = Vec::new();
        uploads.extend(self.uniforms.upload(uniform_bytes));
        self.recorder.add_uploads(&prepared, &mut uploads);
        let staged = StagedUploads::new(device, &uploads)?;
        let draws = views.iter().any(|draws| draws.plan != Plan::Keep);
        if draws && staged.is_empty() {
            // Nothing was created on the device so far, so that a lost device has not been noticed
            // yet.
            capture_device_errors(device, || ()).map_err(|refusal| {
                ShadowError::Device(DeviceError {
                    object: "a depth pass",
                    refusal,
                })
            })?;
        }
        // Nothing fails from here on.
        staged.commit(encoder, &uploads);
        self.uniforms.set_written(uniform_bytes);
        self.memory.uniforms = std::mem::replace(&mut self.uniform_values, uniform_values);
        let recorded = self
            .recorder
            .record(encoder, &self.map, prepared, &mut views, &casters);
        (self.report.passes, self.report.draws) = (recorded.passes, recorded.draws);
        let mut old_views = std::mem::replace(&mut self.views, views);
        let lists = old_views.drain(..).map(|draws| draws.casters);
        self.memory.casters.extend(lists);
        self.memory.views = old_views;
        self.report.predicted_error = predicted_error;
        self.fill_report(layers, &casters);
        self.is_unchanged =
            self.views.iter().all(|draws| !draws.deferred) && self.report.passes == 0;
        Ok(&self.report)
    }

    /// Returns whether a frame that is equal to the last leaves all views as they are.
    pub(crate) fn is_unchanged(&self) -> bool {
        self.is_unchanged
    }

    /// Returns the report of a frame that leaves all views as they are.
    pub(crate) fn keep(&mut self, casters: &FrameCasters<'_>) -> &ShadowReport {
        self.report.note_frame(casters);
        &self.report
    }

    /// Returns the uniforms of the frame, one per view.
    fn uniforms_of(
        &mut self,
        layers: &[LayerState],
        views: &[ViewDraws],
        camera_render: Option<Vec3>,
    ) -> Vec<ShadowViewUniform> {
        let mut uniforms = std::mem::take(&mut self.memory.uniforms);
        uniforms.clear();
        let layer_of = layer_of(self.shares_layer);
        let empty = |index| empty_view_uniform(layer_of(index), Vec3::ZERO, f64::INFINITY);
        uniforms.extend((0..self.view_count).map(empty));
        for base in layers {
            let (anchor, range) = (base.anchor_render, base.range_world);
            let layer = layer_of(base.index);
            uniforms[base.index as usize] = empty_view_uniform(layer, anchor, range);
        }
        for light in lights(views, self.views_per_light) {
            LightUniforms::of(light).fill(
                &mut uniforms,
                light,
                self.views_per_light,
                layers,
                &self.sampling,
                &layer_of,
            );
        }
        for base in layers {
            uniforms[base.index as usize].limit = base.limit;
        }
        for uniform in &mut uniforms {
            uniform.sample_radius = self.sampling.filter.radius_world();
            uniform.camera = camera_render.map_or([0.0; 4], |camera| camera.extend(1.0).to_array());
        }
        uniforms
    }

    fn fill_report(&mut self, layers: &[LayerState], casters: &FrameCasters<'_>) {
        let layer_of = layer_of(self.shares_layer);
        let lights = lights(&self.views, self.views_per_light);
        let sampled = lights.flat_map(|light| {
            let shared = LightUniforms::of(light);
            light
                .iter()
                .map(move |draws| (draws, shared.sampled(&draws.view)))
        });
        let mut views = sampled.peekable();
        let reports = layers.iter().map(|base| {
            match views.next_if(|(draws, _)| draws.view.index() == base.index) {
                None if base.deferred => ViewReport {
                    status: ViewStatus::Deferred,
                    ..ViewReport::empty(layer_of(base.index))
                },
                None => ViewReport::empty(layer_of(base.index)),
                Some((draws, sampled)) => ViewReport {
                    slice: base.slice,
                    max_peter_panning_world: self.sampling.max_peter_panning_world(&sampled),
                    ..ViewReport::of(draws, casters)
                },
            }
        });
        self.report.bytes_held = self.map.bytes() + self.recorder.bytes();
        self.report.views.clear();
        self.report.views.extend(reports);
        self.report.note_frame(casters);
    }

    /// Returns how often `draws` needs its view rendered.
    pub(crate) fn renders(&self, draws: &ViewDraws, casters: &FrameCasters<'_>) -> u32 {
        self.recorder.renders(draws, casters)
    }

    /// Returns whether the layer of `view` still contains what was last drawn for that view.
    pub(crate) fn holds(&self, view: &ShadowView) -> bool {
        self.recorder.holds(view)
    }
}

/// Returns a function from the index of a view to its layer.
fn layer_of(shares_layer: bool) -> impl Fn(u32) -> u32 {
    move |index| if shares_layer { 0 } else { index }
}
