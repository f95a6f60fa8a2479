//! `SpotShadow`: a light that shines into a cone.

use glam::{DVec3, Vec3};

use crate::check;
use crate::fit::{LightAxes, MAX_LOCAL_VIEWS};
use crate::light::layer_limits::check_layers;
use crate::light::local::{LocalLights, LocalPlacement};
use crate::receive::{
    Sampling, Selection, ShadowMaps, ShadowMapsDescriptor, check_bias, check_planar_filter,
};
use crate::{Bias, Filter, ShadowError, ShadowFrame, report::ShadowReport};

/// What a [`SpotShadow`] is made of.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpotShadowDescriptor<'a> {
    /// Label from which all objects derive theirs. Default "spot shadow".
    pub label: wgpu::Label<'a>,
    /// Texels per side of the map, 1 up to the device's `max_texture_dimension_2d`. Default 1024.
    pub map_size: u32,
    /// How a map is looked up.
    pub filter: Filter,
    /// How receivers are kept from shadowing themselves.
    pub bias: Bias,
}

impl Default for SpotShadowDescriptor<'_> {
    fn default() -> Self {
        Self {
            label: None,
            map_size: 1024,
            filter: Filter::default(),
            bias: Bias::Auto,
        }
    }
}

/// A light at a place that shines into a cone.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpotLight {
    /// Absolute world position (f64). The near plane of the map is at the bounds of the nearest caster, but no nearer than
    /// 1/1024 of half their largest side. Where bounds contain the light, as those of a lamp shade or of a room do, it is at
    /// 1/16 of half their smallest side. Both limits are at most 1/1024 of the distance to the farthest receiver that is
    /// seen. What lies before the near plane casts nothing.
    pub position_world: DVec3,
    /// Direction in which it shines, any length but zero; world axes.
    pub direction: Vec3,
    /// Angle in radians from the axis to the rim of the cone (half of what it spans); above 0, below π/2. Outside the cone
    /// visibility is 1: attenuation belongs to the engine. A map is flat, so its texels grow toward the rim; from
    /// [`SpotLight::WIDEST_SENSIBLE_OUTER_ANGLE`] on, a point light of the same memory is finer in the middle.
    pub outer_angle_radians: f32,
    /// Distance in world units beyond which the light neither draws casters nor shadows receivers; above 0, infinity allowed. An
    /// end that is far away costs no precision: maps are fitted to what is seen within it.
    pub range: f32,
}

impl SpotLight {
    /// Half-angle at which one map of 6 N² texels is as fine in its middle as a cube's faces of N² texels: atan √6 = 67.8°.
    /// An [`OmniShadow`](crate::OmniShadow) serves wider cones better.
    pub const WIDEST_SENSIBLE_OUTER_ANGLE: f32 = 1.183_199_6;
}

/// Shadows of a spot light: one perspective view in a depth texture of one layer.
#[derive(Debug)]
pub struct SpotShadow {
    maps: ShadowMaps,
    lights: LocalLights,
}

impl SpotShadow {
    /// Makes texture and buffers. Until the first [`SpotShadow::record`], everything is lit.
    ///
    /// # Errors
    /// [`ShadowError`] for a descriptor out of range, or a device that cannot hold it.
    pub fn new(
        device: &wgpu::Device,
        descriptor: &SpotShadowDescriptor<'_>,
    ) -> Result<Self, ShadowError> {
        check_planar_filter("SpotShadowDescriptor::filter", descriptor.filter)?;
        check_bias("SpotShadowDescriptor::bias", descriptor.bias)?;
        check_layers(device, "the map of a SpotShadow", 1)?;
        let maps = ShadowMaps::new(
            device,
            &ShadowMapsDescriptor {
                label: descriptor.label.unwrap_or("spot shadow"),
                size_field: "SpotShadowDescriptor::map_size",
                map_size: descriptor.map_size,
                layers: 1,
                sampling: Sampling::new(descriptor.filter, descriptor.bias),
                selection: Selection::OneView,
                views_per_light: 1,
                indexed: false,
            },
        )?;
        Ok(Self {
            maps,
            lights: LocalLights::new(device, 1),
        })
    }

    /// Fits the view to the frame, culls, writes the uniforms and records the depth pass if it is needed.
    ///
    /// The encoder must be submitted before anything that asks for these shadows, and encoders in the order in which they were
    /// recorded ([what a kept map relies on](crate#what-a-kept-map-relies-on)).
    ///
    /// # Errors
    /// [`ShadowError`] for input that is not finite, or an angle or range out of its limits. Nothing is recorded then, and the
    /// last good map remains.
    pub fn record(
        &mut self,
        encoder: &mut wgpu::CommandEncoder,
        frame: &ShadowFrame<'_>,
        light: &SpotLight,
    ) -> Result<&ShadowReport, ShadowError> {
        let light = light.placement(0, 1.0)?;
        self.lights
            .record(&mut self.maps, encoder, frame, &[light], None)
    }
    /// Returns the light's depth texture, uniforms and report.
    pub fn maps(&self) -> &ShadowMaps {
        &self.maps
    }

    /// Says that the maps no longer hold what was recorded ([what a kept map relies on](crate#what-a-kept-map-relies-on)): the
    /// next frame draws every view.
    pub fn invalidate(&mut self) {
        self.maps.invalidate();
    }
}

impl SpotLight {
    /// Returns the light in a slot of its maps if its numbers are sound.
    pub(crate) fn placement(
        &self,
        slot: u32,
        importance: f32,
    ) -> Result<LocalPlacement, ShadowError> {
        let direction = self.direction.as_dvec3();
        check::finite_vector("SpotLight::position_world", self.position_world)?;
        check::above_zero("SpotLight::range", self.range)?;
        check::direction("SpotLight::direction", direction)?;
        check::in_range(
            "SpotLight::outer_angle_radians",
            "above 0 and below π/2",
            self.outer_angle_radians > 0.0
                && self.outer_angle_radians < std::f32::consts::FRAC_PI_2,
            self.outer_angle_radians,
        )?;
        let outer_angle = f64::from(self.outer_angle_radians);
        Ok(LocalPlacement {
            slot,
            position_world: self.position_world,
            range: self.range,
            axes: [LightAxes::new(direction, DVec3::Y); MAX_LOCAL_VIEWS],
            view_count: 1,
            tangent: outer_angle.tan(),
            cone_cosine: outer_angle.cos(),
            importance,
        })
    }
}
