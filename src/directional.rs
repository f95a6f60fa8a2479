//! `DirectionalShadow`: the sun.

use glam::{DVec3, Vec3};

use crate::cast::{DepthMap, Recorder, ShadowCaster, UploadBuffer, ViewDraws};
use crate::check;
use crate::fit::{CasterBounds, DirectionalFit, FitInput, FitLimits, LightAxes, Region};
use crate::receive::{Receiver, Sampling, ShadowSource, ShadowViewUniform, view_uniform};
use crate::report::{ShadowReport, ViewReport, ViewStatus};
use crate::{Aabb, Bias, CameraView, CascadeSplit, Filter, ShadowError, ShadowView};

/// What a [`DirectionalShadow`] is made of.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DirectionalShadowDescriptor<'a> {
    /// Label from which all objects derive theirs. Default "directional shadow".
    pub label: wgpu::Label<'a>,
    /// Texels per side of each cascade's map, 1 up to the device's `max_texture_dimension_2d`. Default 2048. Cost and memory
    /// grow with its square, the blur and misplacement of an edge shrink with it.
    pub map_size: u32,
    /// Cascades, 1..=8. Default 1, which suits a scene as deep as it is wide; a view to the horizon wants 3 or 4.
    pub cascades: u32,
    /// Where one cascade ends and the next begins. Default logarithmic.
    pub split: CascadeSplit,
    /// How a map is looked up.
    pub filter: Filter,
    /// How receivers are kept from shadowing themselves.
    pub bias: Bias,
}

impl Default for DirectionalShadowDescriptor<'_> {
    fn default() -> Self {
        Self {
            label: None,
            map_size: 2048,
            cascades: 1,
            split: CascadeSplit::Logarithmic,
            filter: Filter::default(),
            bias: Bias::Auto,
        }
    }
}

/// A light so far away that its rays are parallel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DirectionalLight {
    /// Direction in which the light shines (from the sun to the ground), any length but zero; world axes.
    pub direction: Vec3,
    /// The world's up axis, any length but zero: the map's x axis is horizontal, so that level ground under a low sun
    /// fills the map. Default +Y.
    pub up: Vec3,
}

impl DirectionalLight {
    /// Light along `direction` in a world whose up axis is +Y.
    pub const fn new(direction: Vec3) -> Self {
        Self {
            direction,
            up: Vec3::Y,
        }
    }
}

/// What the maps of a directional light are to cover.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum Coverage {
    /// A fixed box in render space, held by the first cascade alone, as in the textbook. Surfaces outside are lit.
    Bounds(Aabb),
    /// What a camera sees of casters and receivers.
    Camera(CameraView),
}

/// What a directional light needs to know of a frame.
#[derive(Clone, Copy)]
pub struct DirectionalFrame<'a> {
    /// World position of render space's origin, f64. Zero unless the engine renders relative to its camera.
    pub origin: DVec3,
    /// The light.
    pub light: DirectionalLight,
    /// What to cover.
    pub coverage: Coverage,
    /// Everything that may cast; all of it receives, too.
    pub casters: &'a [&'a dyn ShadowCaster],
    /// Bounds in render space of surfaces that only receive.
    pub receivers: &'a [Aabb],
}

/// Shadows of a directional light: a depth texture with one layer per cascade, its uniforms, and what is needed to fill them.
#[derive(Debug)]
pub struct DirectionalShadow {
    map: DepthMap,
    recorder: Recorder,
    uniforms: UploadBuffer,
    sampling: Sampling,
    limits: FitLimits,
    fit: DirectionalFit,
    views: Vec<ViewDraws>,
    report: ShadowReport,
    scratch: Scratch,
}

/// Lists that keep their memory from frame to frame.
#[derive(Debug, Default)]
struct Scratch {
    bounds: Vec<Aabb>,
    casters: Vec<CasterBounds>,
    spare_views: Vec<ViewDraws>,
}

impl DirectionalShadow {
    /// Makes texture and buffers. Until the first [`DirectionalShadow::record`], everything is lit.
    ///
    /// # Errors
    /// [`ShadowError`] for a descriptor out of range, or a device that cannot hold it.
    pub fn new(
        device: &wgpu::Device,
        descriptor: &DirectionalShadowDescriptor<'_>,
    ) -> Result<Self, ShadowError> {
        let label = descriptor.label.unwrap_or("directional shadow");
        check::in_range(
            "DirectionalShadowDescriptor::cascades",
            "in 1..=8",
            (1..=8).contains(&descriptor.cascades),
            descriptor.cascades,
        )?;
        check::split("DirectionalShadowDescriptor::split", descriptor.split)?;
        check::filter("DirectionalShadowDescriptor::filter", descriptor.filter)?;
        check::bias("DirectionalShadowDescriptor::bias", descriptor.bias)?;
        let map = DepthMap::new(
            device,
            label,
            "DirectionalShadowDescriptor::map_size",
            descriptor.map_size,
            descriptor.cascades,
        )?;
        let recorder = Recorder::new(device, label, descriptor.cascades)?;
        let uniforms = UploadBuffer::new(
            device,
            &format!("{label} views"),
            u64::from(descriptor.cascades) * size_of::<ShadowViewUniform>() as u64,
        )?;
        let report = ShadowReport {
            views: Vec::new(),
            bytes_held: map.bytes(),
        };
        Ok(Self {
            map,
            recorder,
            uniforms,
            sampling: Sampling {
                filter: descriptor.filter,
                bias: descriptor.bias,
            },
            limits: FitLimits {
                map_size: descriptor.map_size,
                margin_texels: descriptor.filter.margin_texels(),
                cascades: descriptor.cascades as usize,
                split: descriptor.split,
            },
            fit: DirectionalFit::default(),
            views: Vec::new(),
            report,
            scratch: Scratch::default(),
        })
    }

    /// Fits the cascades to the frame, culls, writes the uniforms and records the depth passes that are needed.
    ///
    /// The encoder must be submitted before anything that asks for these shadows. One that is thrown away takes its depth
    /// passes with it: then call [`DirectionalShadow::invalidate`].
    ///
    /// # Errors
    /// [`ShadowError`] for input that is not finite or not a camera, light or box. Nothing is recorded then, and the last good
    /// maps remain.
    pub fn record(
        &mut self,
        device: &wgpu::Device,
        encoder: &mut wgpu::CommandEncoder,
        frame: &DirectionalFrame<'_>,
    ) -> Result<&ShadowReport, ShadowError> {
        let axes = check_light(frame)?;
        let region = match frame.coverage {
            Coverage::Bounds(bounds) => {
                check::bounds("DirectionalFrame::coverage", 0, &bounds)?;
                Region::Bounds(bounds)
            }
            Coverage::Camera(camera) => Region::Camera(camera.frustum()?),
        };
        check::caster_bounds(frame.casters, &mut self.scratch.bounds)?;
        for (index, bounds) in frame.receivers.iter().enumerate() {
            check::bounds("DirectionalFrame::receivers", index, bounds)?;
        }
        let input = FitInput {
            axes,
            origin: frame.origin,
            region,
            casters: &self.scratch.bounds,
            receivers: frame.receivers,
        };
        let fit = self
            .fit
            .fit(&input, &self.limits, &mut self.scratch.casters)?;
        let mut views = self.cull(&fit, &axes, frame.origin);
        let uniforms = uniforms_of(&views, self.map.layers(), &self.sampling);
        let upload = self
            .uniforms
            .prepare(device, bytemuck::cast_slice(&uniforms))?;
        let prepared = self.recorder.prepare(device, &views)?;
        // Nothing fails from here on.
        self.fit = fit;
        self.uniforms.commit(encoder, upload);
        self.recorder
            .record(encoder, &self.map, prepared, &mut views, frame.casters);
        let outdated = std::mem::replace(&mut self.views, views);
        self.scratch.spare_views = outdated;
        self.fill_report(frame.casters.len());
        Ok(&self.report)
    }

    /// Says that the maps no longer hold what was recorded (an encoder was dropped, the textures were written by others):
    /// the next frame draws every view.
    pub fn invalidate(&mut self) {
        self.recorder.invalidate();
        self.uniforms.invalidate();
    }

    /// What [`ShadowBindings`](crate::ShadowBindings) needs of this light.
    pub fn source(&self) -> ShadowSource<'_> {
        ShadowSource {
            receiver: Receiver {
                map: self.map.array_view(),
                views: self.uniforms.buffer(),
                view_count: self.map.layers(),
                sampling: self.sampling,
            },
        }
    }

    /// The views of the last frame, near cascades first; those that nothing casts into are left out.
    pub fn views(&self) -> impl ExactSizeIterator<Item = &ShadowView> {
        self.views.iter().map(|draws| &draws.view)
    }

    /// Uniforms of the last frame, one per cascade: what [`DirectionalShadow::uniform_buffer`] holds.
    pub fn view_uniforms(&self) -> Vec<ShadowViewUniform> {
        uniforms_of(&self.views, self.map.layers(), &self.sampling)
    }

    /// The depth texture: `Depth32Float`, reversed, one layer per cascade. Usable as a copy source.
    pub fn texture(&self) -> &wgpu::Texture {
        self.map.texture()
    }

    /// All layers as a `texture_depth_2d_array`.
    pub fn texture_view(&self) -> &wgpu::TextureView {
        self.map.array_view()
    }

    /// Uniform buffer with one [`ShadowViewUniform`] per cascade.
    pub fn uniform_buffer(&self) -> &wgpu::Buffer {
        self.uniforms.buffer()
    }

    /// What the last frame did.
    pub fn report(&self) -> &ShadowReport {
        &self.report
    }

    /// The cascades that something casts into, with the casters of each.
    fn cull(&mut self, fit: &DirectionalFit, axes: &LightAxes, origin: DVec3) -> Vec<ViewDraws> {
        let windows = &fit.windows[..self.limits.cascades];
        let mut views = Vec::with_capacity(windows.len());
        for (layer, window) in windows.iter().enumerate() {
            let Some(window) = window else { continue };
            let spare = self.scratch.spare_views.pop();
            let mut casters = spare.map(|draws| draws.casters).unwrap_or_default();
            casters.clear();
            casters.extend(
                (0u32..)
                    .zip(&self.scratch.casters)
                    .filter(|(_, caster)| caster.can_shadow && window.holds_part_of(&caster.light))
                    .map(|(index, _)| index),
            );
            views.push(ViewDraws {
                view: ShadowView::orthographic(axes, window, origin, layer as u32),
                casters,
                drawn: false,
            });
        }
        views
    }

    fn fill_report(&mut self, caster_count: usize) {
        self.report.views.clear();
        for layer in 0..self.map.layers() {
            let draws = self.views.iter().find(|draws| draws.view.layer() == layer);
            self.report.views.push(match draws {
                None => ViewReport {
                    layer,
                    status: ViewStatus::Empty,
                    casters: 0,
                    culled: caster_count as u32,
                    texel_size_world: glam::Vec2::ZERO,
                    depth_range_world: 0.0,
                    worst_gap_world: 0.0,
                },
                Some(draws) => ViewReport {
                    layer,
                    status: if draws.drawn {
                        ViewStatus::Drawn
                    } else {
                        ViewStatus::Kept
                    },
                    casters: draws.casters.len() as u32,
                    culled: (caster_count - draws.casters.len()) as u32,
                    texel_size_world: draws.view.texel_size_world(),
                    depth_range_world: draws.view.depth_range_world(),
                    worst_gap_world: self
                        .sampling
                        .bias
                        .worst_gap_world(self.sampling.filter, &draws.view),
                },
            });
        }
    }
}

/// One uniform per layer; empty for layers without a view.
fn uniforms_of(views: &[ViewDraws], layers: u32, sampling: &Sampling) -> Vec<ShadowViewUniform> {
    (0..layers)
        .map(|layer| {
            let draws = views.iter().find(|draws| draws.view.layer() == layer);
            view_uniform(draws.map(|draws| &draws.view), layer, sampling)
        })
        .collect()
}

fn check_light(frame: &DirectionalFrame<'_>) -> Result<LightAxes, ShadowError> {
    check::finite_vector("DirectionalFrame::origin", frame.origin)?;
    let direction = frame.light.direction.as_dvec3();
    let up = frame.light.up.as_dvec3();
    check::direction("DirectionalFrame::light.direction", direction)?;
    check::direction("DirectionalFrame::light.up", up)?;
    Ok(LightAxes::new(direction, up))
}
