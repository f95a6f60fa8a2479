//! `DirectionalShadow`: the sun.

use glam::{DVec3, Vec3};

use crate::cast::{CasterAnswers, FrameCasters, ShadowCaster, ViewDraws};
use crate::check;
use crate::fit::{
    CameraFrustum, Column, DirectionalFit, FitInput, FitLimits, FitScratch, LightAxes,
    MAX_CASCADES, Region, Spacing,
};
use crate::light_maps::{LayerBase, LightMaps, LightMapsDescriptor, MapsFrame, light_maps_getters};
use crate::receive::{Sampling, Selection};
use crate::report::ShadowReport;
use crate::{
    Aabb, Bias, CameraView, CascadeSplit, DepthFormat, Filter, ShadowError, ShadowView, Stability,
};

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
    /// Share of a cascade's width, 0..=0.5, over which it gives way to the next toward its border. Default 0: a cascade ends
    /// where its map ends, and the edges of shadows widen there at once. A tenth hides that; inside it two maps are looked up.
    /// Too large a share costs lookups and lets the coarser map blur what the finer one holds.
    pub blend: f32,
    /// What may change the extent of a cascade.
    pub stability: Stability,
    /// How the maps store depths. `Unorm16` halves their memory; casters need pipelines for it
    /// ([`CasterPipelineDescriptor::depth_formats`](crate::CasterPipelineDescriptor::depth_formats)).
    pub depth_format: DepthFormat,
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
            blend: 0.0,
            stability: Stability::Rungs,
            depth_format: DepthFormat::Float32,
        }
    }
}

impl DirectionalShadowDescriptor<'_> {
    /// One gather a lookup and a quarter of the default's texels: the cheapest that keeps edges smooth, with one and a half
    /// times the default's error.
    pub const CHEAP: Self = Self {
        label: None,
        map_size: 1024,
        cascades: 1,
        split: CascadeSplit::Logarithmic,
        filter: Filter::Bilinear { sharpness: 1.0 },
        bias: Bias::Auto,
        blend: 0.0,
        stability: Stability::Rungs,
        depth_format: DepthFormat::Float32,
    };

    /// Nine gathers a lookup and four times the default's texels, for seven tenths of the default's error. Measured, as are the
    /// default and [`CHEAP`](Self::CHEAP), by `cargo bench --bench speed_vs_error`: none of the three is beaten at its cost.
    pub const ACCURATE: Self = Self {
        map_size: 4096,
        filter: Filter::TentMedium { sharpness: 4.0 },
        ..Self::CHEAP
    };
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
    /// World position of render space's origin, f64. Zero unless the engine renders relative to its camera. Texels keep their
    /// places in the world, so f64 must tell them apart there: with texels of `t` units, in maps of 64 or more a side, a frame is
    /// accepted up to at least `2⁴⁷ t` units from the world's origin, 1.4·10¹² for a centimetre. Some hundred times as far it is
    /// [`ShadowError::ViewNotRepresentable`].
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
    maps: LightMaps,
    limits: FitLimits,
    fit: DirectionalFit,
    answers: CasterAnswers,
    scratch: FitScratch,
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
        check::in_range(
            "DirectionalShadowDescriptor::cascades",
            "in 1..=8",
            (1..=MAX_CASCADES as u32).contains(&descriptor.cascades),
            descriptor.cascades,
        )?;
        check::split(
            "DirectionalShadowDescriptor::split",
            descriptor.split,
            descriptor.cascades,
        )?;
        check::in_range(
            "DirectionalShadowDescriptor::blend",
            "in 0..=0.5",
            (0.0..=0.5).contains(&descriptor.blend),
            descriptor.blend,
        )?;
        check::planar_filter("DirectionalShadowDescriptor::filter", descriptor.filter)?;
        check::in_range(
            "DirectionalShadowDescriptor::filter",
            "of an angular diameter below π",
            descriptor.filter.light_size() < std::f32::consts::PI,
            descriptor.filter.light_size(),
        )?;
        check::bias("DirectionalShadowDescriptor::bias", descriptor.bias)?;
        let sampling = Sampling {
            filter: descriptor.filter,
            bias: descriptor.bias,
            depth_format: descriptor.depth_format,
            blend: descriptor.blend,
        };
        let maps = LightMaps::new(
            device,
            &LightMapsDescriptor {
                label: descriptor.label.unwrap_or("directional shadow"),
                size_field: "DirectionalShadowDescriptor::map_size",
                map_size: descriptor.map_size,
                layers: descriptor.cascades,
                sampling,
                selection: Selection::Cascades,
                views_per_light: descriptor.cascades,
                indexed: false,
            },
        )?;
        Ok(Self {
            maps,
            limits: FitLimits {
                map_size: descriptor.map_size,
                margin_texels: sampling.margin_texels(),
                cascades: descriptor.cascades as usize,
                split: descriptor.split,
                stability: descriptor.stability,
            },
            fit: DirectionalFit::default(),
            answers: CasterAnswers::default(),
            scratch: FitScratch::default(),
        })
    }

    /// Fits the cascades to the frame, culls, writes the uniforms and records the depth passes that are needed.
    ///
    /// The encoder must be submitted before anything that asks for these shadows, and encoders in the order in which they were
    /// recorded ([what a kept map relies on](crate#what-a-kept-map-relies-on)).
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
        let frustum;
        let region = match frame.coverage {
            Coverage::Bounds(bounds) => {
                check::bounds("DirectionalFrame::coverage", 0, &bounds)?;
                Region::Bounds(bounds)
            }
            Coverage::Camera(camera) => {
                frustum = self.frustum(&camera)?;
                Region::Camera(&frustum)
            }
        };
        let mut answers = std::mem::take(&mut self.answers);
        let casters = answers.ask("DirectionalFrame::casters", frame.casters)?;
        check::receiver_bounds("DirectionalFrame::receivers", frame.receivers)?;
        let input = FitInput {
            axes,
            origin: frame.origin,
            region,
            casters: casters.bounds,
            receivers: frame.receivers,
        };
        let fit = self.fit.fit(&input, &self.limits, &mut self.scratch)?;
        let views = self.cull(&fit, &axes, frame.origin, &casters)?;
        let layers: [_; MAX_CASCADES] =
            std::array::from_fn(|layer| LayerBase::directional(layer as u32, fit.slices[layer]));
        let maps_frame = MapsFrame {
            views,
            layers: &layers[..self.limits.cascades],
            viewer_render: None,
            casters,
        };
        let report = self.maps.record(device, encoder, maps_frame)?;
        self.fit = fit;
        self.answers = answers;
        Ok(report)
    }

    fn frustum(&self, camera: &CameraView) -> Result<CameraFrustum, ShadowError> {
        const DISTANCE: &str = "DirectionalFrame::coverage.max_distance";
        let frustum = camera.frustum(
            "DirectionalFrame::coverage.view_from_render",
            "DirectionalFrame::coverage.clip_from_view",
            DISTANCE,
        )?;
        let (near, far) = frustum.depth_range();
        check::in_range(
            DISTANCE,
            "finite under Stability::Rotation, where the projection has no far plane",
            self.limits.stability == Stability::Rungs || (near.is_finite() && far.is_finite()),
            camera.max_distance,
        )?;
        Ok(frustum)
    }

    /// The cascades that something casts into, with the casters of each.
    fn cull(
        &mut self,
        fit: &DirectionalFit,
        axes: &LightAxes,
        origin: DVec3,
        casters: &FrameCasters<'_>,
    ) -> Result<Vec<ViewDraws>, ShadowError> {
        let windows = &fit.windows[..self.limits.cascades];
        let mut views = self.maps.spare_views();
        for (layer, window) in windows.iter().enumerate() {
            let Some(window) = window else { continue };
            let spacing = Spacing::around(origin, &window.bounds());
            let column = Column::new(axes, origin, &window.plane);
            let mut drawn = self.maps.spare_list();
            let all = (0u32..).zip(self.scratch.casters.iter().zip(casters.bounds));
            drawn.extend(all.filter_map(|(index, (caster, bounds))| {
                let marks = caster.can_shadow
                    && window.holds_part_of(&caster.widest_light(spacing))
                    && column.meets(bounds);
                marks.then_some(index)
            }));
            let view = ShadowView::orthographic(axes, window, origin, layer as u32).checked()?;
            views.push(ViewDraws::new(view, drawn));
        }
        Ok(views)
    }
}

light_maps_getters!(DirectionalShadow, "cascade");

fn check_light(frame: &DirectionalFrame<'_>) -> Result<LightAxes, ShadowError> {
    check::finite_vector("DirectionalFrame::origin", frame.origin)?;
    let direction = frame.light.direction.as_dvec3();
    let up = frame.light.up.as_dvec3();
    check::direction("DirectionalFrame::light.direction", direction)?;
    check::direction("DirectionalFrame::light.up", up)?;
    Ok(LightAxes::new(direction, up))
}
