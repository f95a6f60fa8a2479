//! Defines `DirectionalShadow`: the shadows of the sun and of other distant lights.

use glam::Vec3;

use crate::cast::{FrameCasters, ViewDraws};
use crate::check;
use crate::fit::{
    CascadeLayout, DirectionalFit, FitInput, FitLimits, FitScratch, LightAxes, LightSpace,
    MAX_CASCADES, Region, TexelRect,
};
use crate::light::distance_limit::{distance_limit, shadowed_texels};
use crate::light::large_triangles::depth_reach;
use crate::light::scene::FrameVersion;
use crate::receive::{
    LayerState, MapsFrame, Sampling, Selection, ShadowMaps, ShadowMapsDescriptor, ShadowReport,
    check_bias, check_fade, check_planar_filter,
};
use crate::{Bias, DepthFormat, Filter, ShadowError, ShadowFrame, ShadowView, Stability};

/// Describes what a [`DirectionalShadow`] is made of. [`DirectionalShadow::new`] returns
/// [`ShadowError::OutOfRange`] for values outside the ranges given here, and
/// [`ShadowError::OverDeviceLimit`] for those beyond the device's limits.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DirectionalShadowDescriptor<'a> {
    /// Is the label from which all wgpu objects of the light derive theirs; "directional shadow" if
    /// `None`, the default.
    pub label: wgpu::Label<'a>,
    /// Is the number of texels per side of the map that all cascades share, or of each cascade's
    /// own under [`CascadeLayout::Fixed`]: from 1 to the device's `max_texture_dimension_2d`. The
    /// default is 2048. Cost and memory grow with its square; the blur and the displacement of an
    /// edge shrink in proportion to it.
    pub map_size: u32,
    /// Selects how many cascades there are, and how texels are divided among them. The default is
    /// [`CascadeLayout::Automatic`], which finds both.
    pub layout: CascadeLayout<'a>,
    /// Selects how a map is sampled. The default is that of [`Filter`]. Filters for point lights
    /// only are refused, and the light size of [`Filter::Pcss`] and [`Filter::PcssRotated`] is an
    /// angular diameter below π.
    pub filter: Filter,
    /// Selects how receivers are kept from shadowing themselves. The default is [`Bias::Auto`].
    pub bias: Bias,
    /// Is the fraction of a cascade's width, 0..=0.5, over which it blends into the next one toward
    /// its border. The default is 0: a cascade ends where its map ends, and the edges of shadows
    /// become wider there at once. A value of 0.1 hides that; two maps are sampled inside the
    /// blended border. Too large a value costs lookups and lets the coarser map blur what the finer
    /// one resolves.
    pub blend: f32,
    /// Is the fraction of [`CameraView::max_distance`](crate::CameraView::max_distance), in 0..=1,
    /// over which shadows fade to light before they end there. The default is 0: they end at once.
    /// Where no such end is common to all cameras it has no effect.
    pub fade: f32,
    /// Selects what may change the extent of a cascade. The default is [`Stability::TightFit`].
    pub stability: Stability,
    /// Selects how the maps store depths. The default is [`DepthFormat::Float32`]. `Unorm16` halves
    /// their memory; the casters need pipelines for it
    /// ([`CasterPipelineDescriptor::depth_formats`](crate::caster::CasterPipelineDescriptor::depth_formats)).
    pub depth_format: DepthFormat,
}

impl Default for DirectionalShadowDescriptor<'_> {
    fn default() -> Self {
        Self {
            label: None,
            map_size: 2048,
            layout: CascadeLayout::default(),
            filter: Filter::default(),
            bias: Bias::Auto,
            blend: 0.0,
            fade: 0.0,
            stability: Stability::TightFit,
            depth_format: DepthFormat::Float32,
        }
    }
}

impl DirectionalShadowDescriptor<'_> {
    /// Describes a cheaper light whose shadow edges are smooth: the sampler's own comparison, at
    /// half the cycles of the default's lookup, with 1.4 times the default's error.
    pub const CHEAP: Self = Self {
        label: None,
        map_size: 2048,
        layout: CascadeLayout::Automatic { max_cascades: 4 },
        filter: Filter::Hardware,
        bias: Bias::Auto,
        blend: 0.0,
        fade: 0.0,
        stability: Stability::TightFit,
        depth_format: DepthFormat::Float32,
    };

    /// Describes a more accurate light: nine gathers per lookup and four times the default's
    /// texels, with 0.6 times the default's error. `cargo bench --bench speed_vs_error` measures
    /// this one, the default and [`CHEAP`](Self::CHEAP); no measured configuration of the same cost
    /// has a smaller error than any of the three.
    pub const ACCURATE: Self = Self {
        map_size: 4096,
        filter: Filter::Tent5 { sharpness: 4.0 },
        ..Self::CHEAP
    };
}

/// Describes a light that is so far away that its rays are parallel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DirectionalLight {
    /// Is the direction in which the light shines (from the sun to the ground), in world axes,
    /// finite and of any length but zero.
    pub direction: Vec3,
    /// Is the world's up axis, finite and of any length but zero. It orients the map: the map's x
    /// axis is horizontal, so that level ground under a low sun fills the map. Where the light's
    /// direction is within 26° of that axis, the map follows the world's other axes instead.
    /// [`DirectionalLight::new`] sets +Y. A wrong axis costs resolution under a low sun.
    pub up: Vec3,
}

impl DirectionalLight {
    /// Makes a light along `direction` in a world whose up axis is +Y.
    pub const fn new(direction: Vec3) -> Self {
        Self {
            direction,
            up: Vec3::Y,
        }
    }

    /// Returns the light's axes if its vectors are finite and not zero.
    fn axes(&self) -> Result<LightAxes, ShadowError> {
        let (direction, up) = (self.direction.as_dvec3(), self.up.as_dvec3());
        check::direction("DirectionalLight::direction", direction)?;
        check::direction("DirectionalLight::up", up)?;
        Ok(LightAxes::new(direction, up))
    }
}

/// Renders the shadows of a directional light. Owns a depth texture with one layer per cascade or
/// one for all of them, the uniforms of its views, and the state that decides what each frame must
/// draw.
#[derive(Debug)]
pub struct DirectionalShadow {
    maps: ShadowMaps,
    limits: FitLimits,
    fit: DirectionalFit,
    scratch: FitScratch,
    /// Is what the maps were last recorded for.
    last: Option<(FrameVersion, DirectionalLight)>,
}

impl DirectionalShadow {
    /// Creates the light's texture and buffers. Until the first [`DirectionalShadow::record`],
    /// every surface is lit.
    ///
    /// # Errors
    /// Returns [`ShadowError`] for a descriptor with a value out of range, and for a device whose
    /// limits or memory do not suffice or that is lost.
    pub fn new(
        device: &wgpu::Device,
        descriptor: &DirectionalShadowDescriptor<'_>,
    ) -> Result<Self, ShadowError> {
        let layout = &descriptor.layout;
        let cascades = layout.most_cascades();
        check::in_range(
            "DirectionalShadowDescriptor::layout",
            "a layout with a number of cascades in 1..=8",
            (1..=MAX_CASCADES as u32).contains(&cascades),
            cascades,
        )?;
        let split = layout
            .split()
            .checked("DirectionalShadowDescriptor::layout", cascades)?;
        check::in_range(
            "DirectionalShadowDescriptor::blend",
            "in 0..=0.5",
            (0.0..=0.5).contains(&descriptor.blend),
            descriptor.blend,
        )?;
        check_fade("DirectionalShadowDescriptor::fade", descriptor.fade)?;
        check_planar_filter("DirectionalShadowDescriptor::filter", descriptor.filter)?;
        check::in_range(
            "DirectionalShadowDescriptor::filter",
            "a filter with an angular diameter of the light below π",
            descriptor.filter.light_size() < std::f32::consts::PI,
            descriptor.filter.light_size(),
        )?;
        check_bias("DirectionalShadowDescriptor::bias", descriptor.bias)?;
        let sampling = Sampling {
            filter: descriptor.filter,
            bias: descriptor.bias,
            depth_format: descriptor.depth_format,
            blend: descriptor.blend,
            fade: descriptor.fade,
        };
        let maps = ShadowMaps::new(
            device,
            &ShadowMapsDescriptor {
                label: descriptor.label.unwrap_or("directional shadow"),
                size_field: "DirectionalShadowDescriptor::map_size",
                map_size: descriptor.map_size,
                lights: 1,
                layers_field: "DirectionalShadowDescriptor::layout",
                sampling,
                views_per_light: cascades,
                selection: Selection::Cascades,
                shares_layer: layout.is_automatic(),
                indexed: false,
            },
        )?;
        Ok(Self {
            maps,
            limits: FitLimits {
                map_size: descriptor.map_size,
                divides_layer: layout.is_automatic(),
                rects: [TexelRect::whole(descriptor.map_size); MAX_CASCADES],
                margin_texels: sampling.margin_texels(),
                gap_texels: sampling.gap_texels(),
                cascades: cascades as usize,
                split,
                stability: descriptor.stability,
            },
            fit: DirectionalFit::default(),
            scratch: FitScratch::default(),
            last: None,
        })
    }

    /// Fits the cascades to the frame, culls the casters, writes the uniforms, and records the
    /// depth passes that are needed.
    ///
    /// The encoder must be submitted before any work that samples these shadows, and encoders must
    /// be submitted in the order in which they were recorded ([what a kept map relies
    /// on](crate#what-a-kept-map-relies-on)).
    ///
    /// # Errors
    /// Returns [`ShadowError`] for a light whose vectors are not finite or are zero, for a camera
    /// without a finite far end under [`Stability::BoundingSphere`], for a view that cannot be
    /// represented, for casters whose pipelines do not fit the light, and for a device that is lost
    /// or out of memory. Nothing is recorded then, and the maps of the last successful frame
    /// remain.
    pub fn record(
        &mut self,
        encoder: &mut wgpu::CommandEncoder,
        frame: &ShadowFrame<'_>,
        light: &DirectionalLight,
    ) -> Result<&ShadowReport, ShadowError> {
        let last = self.last.take();
        let axes = light.axes()?;
        let input = FitInput {
            space: LightSpace {
                axes,
                origin: frame.origin,
            },
            region: frame.region,
            casters: frame.casters.casting(),
            receivers: frame.receivers,
        };
        if let Some(fit) = self.fit_as_before(last, frame, light, &input) {
            self.fit = fit;
            self.last = Some((frame.version, *light));
            return Ok(self.maps.keep(&frame.casters));
        }
        self.check_distances(frame)?;
        let fit = self.fit.fit(&input, &self.limits, &mut self.scratch)?;
        let views = self.drawn_views(&fit, &input, &frame.casters)?;
        let limit = distance_limit(frame.region, self.maps.sampling().fade);
        let layers: [_; MAX_CASCADES] = std::array::from_fn(|layer| LayerState {
            limit,
            shadowed_texels: shadowed_texels(&input, fit.light_bounds[layer].as_ref()),
            ..LayerState::directional(layer as u32, fit.slices[layer])
        });
        let maps_frame = MapsFrame {
            views,
            layers: &layers[..self.cascades(&fit)],
            predicted_error: fit.predicted_error().map(|error| error as f32),
            camera_render: None,
            casters: frame.casters,
        };
        if fit.layout() != self.fit.layout() {
            // The texels of all cascades may have belonged to others.
            self.maps.invalidate();
        }
        let report = self.maps.record(encoder, maps_frame)?;
        self.fit = fit;
        self.last = Some((frame.version, *light));
        Ok(report)
    }

    /// Returns the fit for a frame that leaves all views as they are: nothing that they depend on
    /// has changed since the last frame. Returns `None` for any other frame.
    fn fit_as_before(
        &self,
        last: Option<(FrameVersion, DirectionalLight)>,
        frame: &ShadowFrame<'_>,
        light: &DirectionalLight,
        input: &FitInput<'_>,
    ) -> Option<DirectionalFit> {
        let (version, _) = last.filter(|(_, last)| last == light && self.maps.is_unchanged())?;
        let changes = frame.changes_since(&version)?;
        let may_change = self.fit.may_change(input, changes);
        (!may_change).then(|| self.fit.again()).flatten()
    }

    /// Checks that the slices of all cameras end at a finite depth where the fit covers the whole
    /// of them.
    fn check_distances(&self, frame: &ShadowFrame<'_>) -> Result<(), ShadowError> {
        let Region::Cameras(cameras) = frame.region else {
            return Ok(());
        };
        for camera in cameras {
            let (near, far) = camera.depth_range();
            check::in_range(
                "CameraView::max_distance",
                "finite under Stability::BoundingSphere, where the projection has no far plane",
                self.limits.stability == Stability::TightFit
                    || (near.is_finite() && far.is_finite()),
                camera.max_distance(),
            )?;
        }
        Ok(())
    }

    /// Returns the views of the cascades into which something casts, with the casters of each.
    fn drawn_views(
        &mut self,
        fit: &DirectionalFit,
        input: &FitInput<'_>,
        casters: &FrameCasters<'_>,
    ) -> Result<Vec<ViewDraws>, ShadowError> {
        let mut views = self.maps.spare_views();
        for cascade in 0..self.cascades(fit) {
            let mut drawn = self.maps.spare_list();
            let Some(light_bounds) = fit.cull(cascade, input, &self.scratch, &mut drawn) else {
                self.maps.return_list(drawn);
                continue;
            };
            let view = ShadowView::orthographic(&input.space, light_bounds, cascade as u32);
            let view = match fit.layout() {
                None => view,
                Some(layout) => view.in_shared_layer(layout.rects[cascade], self.limits.map_size),
            };
            let view = view.checked()?;
            let reach = depth_reach(&view, casters, &drawn);
            views.push(ViewDraws::new(view.over_depths_from(reach), drawn));
        }
        Ok(views)
    }

    /// Returns the number of cascades of a frame.
    fn cascades(&self, fit: &DirectionalFit) -> usize {
        fit.layout()
            .map_or(self.limits.cascades, |layout| layout.cascades)
    }

    /// Returns the light's depth texture, uniforms and report.
    pub fn maps(&self) -> &ShadowMaps {
        &self.maps
    }

    /// Discards the extents of earlier frames. Without this call, extents grow at once and shrink
    /// only after some time, so that moving objects do not change the texels of static ones. Call
    /// it where the camera cuts to another scene.
    pub fn reset_history(&mut self) {
        self.fit = DirectionalFit::default();
        self.last = None;
    }

    /// Declares the contents of the maps invalid ([what a kept map relies
    /// on](crate#what-a-kept-map-relies-on)): the next frame draws every view.
    pub fn invalidate(&mut self) {
        self.maps.invalidate();
    }
}
