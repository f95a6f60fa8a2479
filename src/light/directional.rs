//! `DirectionalShadow`: the sun.

use glam::{DVec3, Vec3};

use crate::cast::{FrameCasters, ViewDraws};
use crate::check;
use crate::fit::{
    CameraFrustum, DirectionalFit, FitInput, FitLimits, FitScratch, LightAxes, MAX_CASCADES,
    Receivers, Region,
};
use crate::receive::{
    LayerState, MapsFrame, NO_LIMIT, Sampling, Selection, ShadowMaps, ShadowMapsDescriptor,
    ShadowReport, check_bias, check_fade, check_planar_filter,
};
use crate::{
    Aabb, Bias, CascadeSplit, DepthFormat, Filter, ShadowError, ShadowFrame, ShadowView, Stability,
};

/// What a [`DirectionalShadow`] is made of.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DirectionalShadowDescriptor<'a> {
    /// Label from which all objects derive theirs. Default "directional shadow".
    pub label: wgpu::Label<'a>,
    /// Texels per side of each cascade's map, 1 up to the device's `max_texture_dimension_2d`. Default 2048. Cost and memory
    /// grow with its square, the blur and misplacement of an edge shrink with it.
    pub map_size: u32,
    /// Cascades, 1..=8, and no more than the device's `max_texture_array_layers`. Default 1, which suits a scene as deep as it is wide; a view to the horizon wants 3 or 4.
    pub cascades: u32,
    /// Where one cascade ends and the next begins. Default logarithmic.
    pub split: CascadeSplit<'a>,
    /// How a map is looked up.
    pub filter: Filter,
    /// How receivers are kept from shadowing themselves.
    pub bias: Bias,
    /// Share of a cascade's width, 0..=0.5, over which it gives way to the next toward its border. Default 0: a cascade ends
    /// where its map ends, and the edges of shadows widen there at once. A tenth hides that; inside it two maps are looked up.
    /// Too large a share costs lookups and lets the coarser map blur what the finer one holds.
    pub blend: f32,
    /// Fraction of [`CameraView::max_distance`](crate::CameraView::max_distance), 0..=1, over which shadows fade to light
    /// before they end there. Default 0: they end at once. Without a distance it has no effect.
    pub fade: f32,
    /// What may change the extent of a cascade.
    pub stability: Stability,
    /// How the maps store depths. `Unorm16` halves their memory; casters need pipelines for it
    /// ([`CasterPipelineDescriptor::depth_formats`](crate::caster::CasterPipelineDescriptor::depth_formats)).
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
            fade: 0.0,
            stability: Stability::TightFit,
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
        fade: 0.0,
        stability: Stability::TightFit,
        depth_format: DepthFormat::Float32,
    };

    /// Nine gathers a lookup and four times the default's texels, for seven tenths of the default's error. Measured, as are the
    /// default and [`CHEAP`](Self::CHEAP), by `cargo bench --bench speed_vs_error`: none of the three is beaten at its cost.
    pub const ACCURATE: Self = Self {
        map_size: 4096,
        filter: Filter::Tent5 { sharpness: 4.0 },
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

    /// Returns the light's axes if its vectors have directions.
    fn axes(&self) -> Result<LightAxes, ShadowError> {
        let (direction, up) = (self.direction.as_dvec3(), self.up.as_dvec3());
        check::direction("DirectionalLight::direction", direction)?;
        check::direction("DirectionalLight::up", up)?;
        Ok(LightAxes::new(direction, up))
    }
}

/// Shadows of a directional light: a depth texture with one layer per cascade, its uniforms, and what is needed to fill them.
#[derive(Debug)]
pub struct DirectionalShadow {
    maps: ShadowMaps,
    limits: FitLimits,
    fit: DirectionalFit,
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
        let split = descriptor
            .split
            .checked("DirectionalShadowDescriptor::split", descriptor.cascades)?;
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
            "of an angular diameter below π",
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
                layers_field: "DirectionalShadowDescriptor::cascades",
                sampling,
                views_per_light: descriptor.cascades,
                selection: Selection::Cascades,
                indexed: false,
            },
        )?;
        Ok(Self {
            maps,
            limits: FitLimits {
                map_size: descriptor.map_size,
                margin_texels: sampling.margin_texels(),
                gap_texels: sampling.gap_texels(),
                cascades: descriptor.cascades as usize,
                split,
                stability: descriptor.stability,
            },
            fit: DirectionalFit::default(),
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
        encoder: &mut wgpu::CommandEncoder,
        frame: &ShadowFrame<'_>,
        light: &DirectionalLight,
    ) -> Result<&ShadowReport, ShadowError> {
        let axes = light.axes()?;
        self.check_distances(frame)?;
        let input = FitInput {
            axes,
            origin: frame.origin,
            region: frame.region,
            casters: frame.casters.bounds,
            shapes: frame.casters.shapes,
            receivers: Receivers {
                bounds: frame.receivers,
                casters: frame.receiver_casters,
            },
        };
        let fit = self.fit.fit(&input, &self.limits, &mut self.scratch)?;
        let views = self.drawn_views(&fit, &input, &frame.casters)?;
        let limit = distance_limit(frame.region, self.maps.sampling().fade);
        let layers: [_; MAX_CASCADES] = std::array::from_fn(|layer| {
            LayerState::directional(layer as u32, limit, fit.slices[layer])
        });
        let maps_frame = MapsFrame {
            views,
            layers: &layers[..self.limits.cascades],
            viewer_render: None,
            casters: frame.casters,
        };
        let report = self.maps.record(encoder, maps_frame)?;
        self.fit = fit;
        Ok(report)
    }

    /// Checks that the slices of all cameras have an end, where the fit goes by the whole of them.
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

    /// Returns the cascades that something casts into, with the casters of each.
    fn drawn_views(
        &mut self,
        fit: &DirectionalFit,
        input: &FitInput<'_>,
        casters: &FrameCasters<'_>,
    ) -> Result<Vec<ViewDraws>, ShadowError> {
        let mut views = self.maps.spare_views();
        for cascade in 0..self.limits.cascades {
            let mut drawn = self.maps.spare_list();
            let Some(light_bounds) = fit.cull(cascade, input, &self.scratch, &mut drawn) else {
                self.maps.return_list(drawn);
                continue;
            };
            let view =
                ShadowView::orthographic(&input.axes, light_bounds, input.origin, cascade as u32);
            let view = view.checked()?;
            let reach = depth_reach(&view, input, casters, &drawn);
            views.push(ViewDraws::new(view.over_depths_from(reach), drawn));
        }
        Ok(views)
    }

    /// Returns the light's depth texture, uniforms and report.
    pub fn maps(&self) -> &ShadowMaps {
        &self.maps
    }

    /// Forgets the extents of earlier frames, which otherwise shrink only after some time, so that what moves does not
    /// change the texels of what stands still. Call it where the camera cuts to another scene.
    pub fn reset_history(&mut self) {
        self.fit = DirectionalFit::default();
    }

    /// Says that the maps no longer hold what was recorded ([what a kept map relies on](crate#what-a-kept-map-relies-on)): the
    /// next frame draws every view.
    pub fn invalidate(&mut self) {
        self.maps.invalidate();
    }
}

/// Is how many times the rounding of a single coordinate the depths of a large triangle are off: the sum of products
/// that gives a corner's depth is rounded, and the interpolation between corners once more.
const LARGE_TRIANGLE_ROUNDING: f64 = 2.0;

/// Returns the largest render coordinate from which depths in the view are computed. Rasterisers interpolate between
/// the corners of a triangle, and each is rounded where it is: a triangle whose corners are far outside the view brings
/// their rounding into it. The size of a caster's triangles is taken to be that of as many equal ones that cover its
/// bounds, or its bounds where their number is not known.
fn depth_reach(
    view: &ShadowView,
    input: &FitInput<'_>,
    casters: &FrameCasters<'_>,
    drawn: &[u32],
) -> f64 {
    let mut reach = view.render_reach();
    let center = view.anchor_render().as_dvec3();
    let radius = reach - center.abs().max_element();
    for &caster in drawn {
        let bounds = &input.casters[caster as usize];
        let corners_away = corners_away(bounds, center, radius);
        if corners_away <= radius {
            continue;
        }
        let diagonal = (bounds.max.as_dvec3() - bounds.min.as_dvec3()).length();
        let pairs = f64::from(casters.facts(caster).triangles.max(2)) * 0.5;
        let away = corners_away.min(diagonal / pairs.sqrt());
        reach = reach.max(view.render_reach() + LARGE_TRIANGLE_ROUNDING * away);
    }
    reach
}

/// Returns the distance from `center` of the fourth nearest corner of a box, which is that of a whole side: near the
/// foot of a high tower, depths follow from the corners at its foot. A box on all sides of the view (a sphere of
/// `radius`) says nothing, and 0 is returned: it is that of a terrain of many triangles, or it is wrong.
fn corners_away(bounds: &Aabb, center: DVec3, radius: f64) -> f64 {
    let (min, max) = (bounds.min.as_dvec3(), bounds.max.as_dvec3());
    if min.cmplt(center - radius).all() && max.cmpgt(center + radius).all() {
        return 0.0;
    }
    let mut distances: [f64; 8] =
        std::array::from_fn(|corner| bounds.corner(corner).as_dvec3().distance(center));
    distances.sort_unstable_by(f64::total_cmp);
    distances[3]
}

/// Is the least fraction of the distance over which shadows end: less is not told apart from a sharp end.
const LEAST_FADE: f64 = 1e-4;

/// Is the cosine of the angle between cameras that count as looking the same way, as the eyes of a headset do.
const SAME_WAY_COSINE: f64 = 0.99;

/// Returns the plane of the uniform at which shadows end: the farthest end of all cameras, if they all have one and look
/// the same way. Otherwise it is no plane, and shadows end where the maps end.
fn distance_limit(region: Region<'_>, fade: f32) -> [f32; 4] {
    let Region::Cameras([first, others @ ..]) = region else {
        return NO_LIMIT;
    };
    let forward = first.forward();
    let end = |camera: &CameraFrustum| {
        let same_way = camera.forward().dot(forward) > SAME_WAY_COSINE;
        let end = -camera.depth(DVec3::ZERO) + camera.max_distance();
        if same_way { end } else { f64::INFINITY }
    };
    let end = others.iter().map(end).fold(end(first), f64::max);
    if !end.is_finite() {
        return NO_LIMIT;
    }
    let over = first.max_distance() * f64::from(fade).max(LEAST_FADE);
    (-forward / over).extend(end / over).as_vec4().to_array()
}
