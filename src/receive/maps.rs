//! What every light owns: a depth map, the recorder that fills it, the uniforms of its views, and a report.

use glam::Vec3;

use crate::cast::{FrameCasters, Plan, Recorder, ViewDraws};
use crate::error::DeviceError;
use crate::gpu::{DepthMap, UploadBuffer, capture_device_errors};
use crate::receive::report::{ShadowReport, ViewReport, ViewStatus};
use crate::receive::sampled_maps::{SampledMaps, Selection};
use crate::receive::{
    Sampling, ShadowViewUniform, empty_view_uniform, endless_range, view_uniform,
};
use crate::{ShadowError, ShadowView, report::SliceReport};

/// What every light owns and what is looked up: a depth texture, a uniform buffer, and how they are to be read.
///
/// A light hands it out by its `maps` method. It goes into a [`ShadowBindings`](crate::ShadowBindings) and a
/// [`DebugView`](crate::debug::DebugView) as it is; the parts are there for engines with their own bind groups. Texture and buffer stay
/// the same for the light's whole life, so a bind group outlives every frame.
#[derive(Debug)]
pub struct ShadowMaps {
    device: wgpu::Device,
    map: DepthMap,
    recorder: Recorder,
    uniforms: UploadBuffer,
    sampling: Sampling,
    selection: Selection,
    views_per_light: u32,
    indexed: bool,
    views: Vec<ViewDraws>,
    uniform_values: Vec<ShadowViewUniform>,
    report: ShadowReport,
    memory: Memory,
}

/// Lists that go from frame to frame for their memory alone.
#[derive(Debug, Default)]
struct Memory {
    casters: Vec<Vec<u32>>,
    views: Vec<ViewDraws>,
    uniforms: Vec<ShadowViewUniform>,
}

/// What a light's maps are made of.
pub(crate) struct ShadowMapsDescriptor<'a> {
    pub label: &'a str,
    /// Path of the size in the caller's descriptor.
    pub size_field: &'static str,
    pub map_size: u32,
    pub layers: u32,
    pub sampling: Sampling,
    pub selection: Selection,
    pub views_per_light: u32,
    /// Lights are asked by index.
    pub indexed: bool,
}

/// A layer that a light of this frame has, and what its uniform says where nothing casts into it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct LayerState {
    pub layer: u32,
    /// The place of a local light.
    pub anchor_render: Vec3,
    /// World distance beyond which the light does not shine; infinite for a directional one.
    pub range_world: f64,
    /// It needed drawing and was put off.
    pub deferred: bool,
    /// Of a cascade of a camera's view.
    pub slice: Option<SliceReport>,
}

impl LayerState {
    pub fn directional(layer: u32, slice: Option<SliceReport>) -> Self {
        Self {
            layer,
            anchor_render: Vec3::ZERO,
            range_world: f64::INFINITY,
            deferred: false,
            slice,
        }
    }
}

/// What a frame brings to the maps.
pub(crate) struct MapsFrame<'a> {
    /// The layers of this frame's lights; all others are lit and not reported.
    pub layers: &'a [LayerState],
    /// The views that something casts into, in the order of `layers`; the other layers are lit.
    pub views: Vec<ViewDraws>,
    /// The camera, if there is one.
    pub viewer_render: Option<Vec3>,
    pub casters: FrameCasters<'a>,
}

impl ShadowMaps {
    pub(crate) fn new(
        device: &wgpu::Device,
        descriptor: &ShadowMapsDescriptor<'_>,
    ) -> Result<Self, ShadowError> {
        let (label, layers) = (descriptor.label, descriptor.layers);
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
                layers,
                descriptor.selection == Selection::CubeFace && !descriptor.indexed,
            )?,
            uniforms: UploadBuffer::new(
                device,
                &format!("{label} views"),
                u64::from(layers) * size_of::<ShadowViewUniform>() as u64,
            )?,
            sampling: descriptor.sampling,
            selection: descriptor.selection,
            views_per_light: descriptor.views_per_light,
            indexed: descriptor.indexed,
            views: Vec::new(),
            uniform_values: vec![empty_view_uniform(0, Vec3::ZERO); layers as usize],
            report,
            memory: Memory::default(),
        })
    }

    pub(crate) fn sampling(&self) -> &Sampling {
        &self.sampling
    }

    /// Returns the depth texture, reversed: near 1, far 0; `Depth32Float`, or as a directional light's
    /// [`DepthFormat`](crate::DepthFormat) says. It has one layer per cascade, spot or cube face (+x, -x, +y, -y, +z, -z); a
    /// pool has those of its slots in order. It is a copy source on all backends but OpenGL.
    pub fn texture(&self) -> &wgpu::Texture {
        self.map.texture()
    }

    /// Returns all layers as a `texture_depth_2d_array`. Where shaders cannot gather (OpenGL ES 3.0, WebGL 2), bind it as
    /// `texture_2d_array<f32>` for all filters but [`Filter::Hardware`](crate::Filter::Hardware).
    pub fn texture_view(&self) -> &wgpu::TextureView {
        self.map.array_view()
    }

    pub(crate) fn map_size(&self) -> u32 {
        self.map.size()
    }

    /// Returns the uniform buffer, which holds one [`ShadowViewUniform`] per layer.
    pub fn uniform_buffer(&self) -> &wgpu::Buffer {
        self.uniforms.buffer()
    }

    /// Returns the uniforms of the last frame, one per layer: what the uniform buffer holds.
    pub fn view_uniforms(&self) -> &[ShadowViewUniform] {
        &self.uniform_values
    }

    /// Returns the views of the last frame, in the order of the frame's lights and of the layers of each; those that nothing casts
    /// into are left out. [`ShadowView::layer`] tells which layer each is in.
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
            view_count: self.map.layers(),
            uniforms: &self.uniform_values,
            sampling: self.sampling,
            selection: self.selection,
            views_per_light: self.views_per_light,
            indexed: self.indexed,
        }
    }

    /// Returns the device that the maps are on.
    pub(crate) fn device(&self) -> &wgpu::Device {
        &self.device
    }

    pub(crate) fn invalidate(&mut self) {
        self.recorder.invalidate();
        self.uniforms.invalidate();
    }

    /// An empty list of caster indices, with the memory of an earlier frame's.
    pub(crate) fn spare_list(&mut self) -> Vec<u32> {
        let mut list = self.memory.casters.pop().unwrap_or_default();
        list.clear();
        list
    }

    /// Takes a list back that no view needed.
    pub(crate) fn return_list(&mut self, list: Vec<u32>) {
        self.memory.casters.push(list);
    }

    /// An empty list of views, with the memory of an earlier frame's.
    pub(crate) fn spare_views(&mut self) -> Vec<ViewDraws> {
        std::mem::take(&mut self.memory.views)
    }

    /// Uploads and records a frame. On an error nothing has been recorded and nothing has changed.
    pub(crate) fn record(
        &mut self,
        encoder: &mut wgpu::CommandEncoder,
        frame: MapsFrame<'_>,
    ) -> Result<&ShadowReport, ShadowError> {
        let MapsFrame {
            layers,
            mut views,
            viewer_render,
            casters,
        } = frame;
        let device = &self.device.clone();
        let prepared = self
            .recorder
            .prepare(device, &self.map, &mut views, &casters)?;
        let uniform_values = self.uniforms_of(layers, &views, viewer_render);
        let upload = self
            .uniforms
            .prepare(device, bytemuck::cast_slice(&uniform_values))?;
        let draws = views.iter().any(|draws| draws.plan != Plan::Keep);
        if draws && upload.is_none() && !prepared.uploads() {
            // Nothing was made on the device, which so had no occasion to say that it is lost.
            capture_device_errors(device, || ()).map_err(|refusal| {
                ShadowError::Device(DeviceError {
                    object: "a depth pass",
                    refusal,
                })
            })?;
        }
        // Nothing fails from here on.
        self.uniforms.commit(encoder, upload);
        self.memory.uniforms = std::mem::replace(&mut self.uniform_values, uniform_values);
        self.report.passes = self
            .recorder
            .record(encoder, &self.map, prepared, &mut views, &casters);
        let mut old_views = std::mem::replace(&mut self.views, views);
        let lists = old_views.drain(..).map(|draws| draws.casters);
        self.memory.casters.extend(lists);
        self.memory.views = old_views;
        self.fill_report(layers, &casters);
        Ok(&self.report)
    }

    /// One uniform per layer of the texture.
    fn uniforms_of(
        &mut self,
        layers: &[LayerState],
        views: &[ViewDraws],
        viewer_render: Option<Vec3>,
    ) -> Vec<ShadowViewUniform> {
        let mut uniforms = std::mem::take(&mut self.memory.uniforms);
        uniforms.clear();
        let layer_count = self.map.layers();
        uniforms.extend((0..layer_count).map(|layer| empty_view_uniform(layer, Vec3::ZERO)));
        for base in layers {
            uniforms[base.layer as usize] = ShadowViewUniform {
                range: endless_range(base.range_world),
                ..empty_view_uniform(base.layer, base.anchor_render)
            };
        }
        for draws in views {
            uniforms[draws.view.layer() as usize] = view_uniform(&draws.view, &self.sampling);
        }
        for uniform in &mut uniforms {
            uniform.sample_radius = self.sampling.filter.radius_world();
            uniform.viewer = viewer_render.map_or([0.0; 4], |viewer| viewer.extend(1.0).to_array());
        }
        uniforms
    }

    fn fill_report(&mut self, layers: &[LayerState], casters: &FrameCasters<'_>) {
        let caster_count = casters.len() as u32;
        let mut views = self.views.iter().peekable();
        let reports = layers.iter().map(|base| {
            match views.next_if(|draws| draws.view.layer() == base.layer) {
                None if base.deferred => ViewReport {
                    status: ViewStatus::Deferred,
                    ..ViewReport::empty(base.layer, caster_count)
                },
                None => ViewReport::empty(base.layer, caster_count),
                Some(draws) => ViewReport {
                    slice: base.slice,
                    ..view_report(draws, &self.sampling, casters)
                },
            }
        });
        self.report.bytes_held = self.map.bytes() + self.recorder.bytes();
        self.report.views.clear();
        self.report.views.extend(reports);
    }

    /// Returns how many depth passes `draws` needs.
    pub(crate) fn passes(&self, draws: &ViewDraws, casters: &FrameCasters<'_>) -> u32 {
        self.recorder.passes(draws, casters)
    }

    /// Does the layer of `view` hold what was last drawn for it?
    pub(crate) fn holds(&self, view: &ShadowView) -> bool {
        self.recorder.holds(view)
    }
}

fn view_report(draws: &ViewDraws, sampling: &Sampling, casters: &FrameCasters<'_>) -> ViewReport {
    let triangles: u64 = draws
        .casters
        .iter()
        .map(|&index| u64::from(casters.facts(index).triangles))
        .sum();
    ViewReport {
        triangles: triangles.saturating_sub(draws.copied_triangles),
        layer: draws.view.layer(),
        status: match draws {
            ViewDraws { deferred: true, .. } => ViewStatus::Deferred,
            ViewDraws {
                plan: Plan::Keep, ..
            } => ViewStatus::Kept,
            _ => ViewStatus::Drawn,
        },
        casters: draws.casters.len() as u32,
        copied: draws.copied,
        culled: (casters.len() - draws.casters.len()) as u32,
        texel_size_world: draws.view.texel_size_world(),
        depth_range_world: draws.view.depth_range_world(),
        max_peter_panning_world: sampling.max_peter_panning_world(&draws.view),
        slice: None,
    }
}
