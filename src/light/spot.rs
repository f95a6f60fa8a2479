//! Defines `SpotShadow`: the shadows of a light that shines into a cone.

use glam::{DVec3, Vec3};

use crate::check;
use crate::fit::{LightAxes, MAX_LOCAL_VIEWS};
use crate::light::local::{LocalLights, LocalPlacement};
use crate::receive::{
    Sampling, Selection, ShadowMaps, ShadowMapsDescriptor, check_bias, check_fade,
    check_planar_filter,
};
use crate::{Bias, Filter, ShadowError, ShadowFrame, report::ShadowReport};

/// Describes what a [`SpotShadow`] is made of. [`SpotShadow::new`] returns
/// [`ShadowError::OutOfRange`] for values outside the ranges given here, and
/// [`ShadowError::OverDeviceLimit`] for those beyond the device's limits.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpotShadowDescriptor<'a> {
    /// Is the label from which all wgpu objects of the light derive theirs; "spot shadow" if
    /// `None`, the default.
    pub label: wgpu::Label<'a>,
    /// Is the number of texels per side of the map: from 1 to the device's
    /// `max_texture_dimension_2d`. The default is
    /// 1024. Cost and memory grow with its square; the blur and the displacement of an edge shrink
    ///       in proportion to it.
    pub map_size: u32,
    /// Selects how the map is sampled. The default is that of [`Filter`]. Filters for point lights
    /// only are refused.
    pub filter: Filter,
    /// Selects how receivers are kept from shadowing themselves. The default is [`Bias::Auto`].
    pub bias: Bias,
    /// Is the fraction of a light's range, in 0..=1, over which shadows fade to light before they
    /// end there. The default is 0: they end at once.
    pub fade: f32,
}

impl Default for SpotShadowDescriptor<'_> {
    fn default() -> Self {
        Self {
            label: None,
            map_size: 1024,
            filter: Filter::default(),
            bias: Bias::Auto,
            fade: 0.0,
        }
    }
}

/// Describes a light at a position that shines into a cone.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpotLight {
    /// Is the absolute world position (f64), finite. The near plane of the map is at the bounds of
    /// the nearest caster, but no nearer than 1/1024 of half their largest side. Where bounds
    /// contain the light, as those of a lamp shade, of a room or of a whole scene do, it is at 1/16
    /// of half their smallest side, or at the distance that costs half a texel of contact at the
    /// farthest receiver that is seen (1/8192 of that receiver's distance in maps of 1024 texels),
    /// whichever is farther. No limit is more than 1/1024 of the distance to that receiver. What
    /// lies before the near plane casts nothing.
    pub position_world: DVec3,
    /// Is the direction in which the light shines, in world axes, finite and of any length but
    /// zero.
    pub direction: Vec3,
    /// Is the angle in radians from the axis to the rim of the cone, half of what the cone spans:
    /// above 0 and below π/2. Outside the cone visibility is 1, since attenuation belongs to the
    /// engine; an angle below that of the engine's attenuation leaves the rim without shadows. The
    /// map is flat, so its texels grow toward the rim. From
    /// [`SpotLight::WIDEST_SENSIBLE_OUTER_ANGLE`] on, a point light with the same memory has finer
    /// texels in the middle of the cone.
    pub outer_angle_radians: f32,
    /// Is the distance in world units beyond which the light neither draws casters nor shadows
    /// receivers; above 0, infinity allowed. An end that is far away costs no precision: maps are
    /// fitted to what is seen within it.
    pub range: f32,
}

impl SpotLight {
    /// Is the half-angle, in radians, at which one map of 6 N² texels is as fine in its middle as
    /// the faces of a cube with N² texels each: atan √6 = 67.8°. An
    /// [`OmniShadow`](crate::OmniShadow) suits wider cones better.
    pub const WIDEST_SENSIBLE_OUTER_ANGLE: f32 = 1.183_199_6;
}

/// Renders the shadows of a spot light: one perspective view in a depth texture of one layer.
#[derive(Debug)]
pub struct SpotShadow {
    lights: LocalLights,
}

impl SpotShadow {
    /// Creates the light's texture and buffers. Until the first [`SpotShadow::record`], every
    /// surface is lit.
    ///
    /// # Errors
    /// Returns [`ShadowError`] for a descriptor with a value out of range, and for a device whose
    /// limits or memory do not suffice or that is lost.
    pub fn new(
        device: &wgpu::Device,
        descriptor: &SpotShadowDescriptor<'_>,
    ) -> Result<Self, ShadowError> {
        check_planar_filter("SpotShadowDescriptor::filter", descriptor.filter)?;
        check_bias("SpotShadowDescriptor::bias", descriptor.bias)?;
        check_fade("SpotShadowDescriptor::fade", descriptor.fade)?;
        let lights = LocalLights::new(
            device,
            &ShadowMapsDescriptor {
                label: descriptor.label.unwrap_or("spot shadow"),
                map_size: descriptor.map_size,
                size_field: "SpotShadowDescriptor::map_size",
                lights: 1,
                layers_field: "the map of a SpotShadow",
                sampling: Sampling {
                    fade: descriptor.fade,
                    ..Sampling::new(descriptor.filter, descriptor.bias)
                },
                views_per_light: 1,
                selection: Selection::OneView,
                shares_layer: false,
                indexed: false,
            },
        )?;
        Ok(Self { lights })
    }

    /// Fits the view to the frame, culls the casters, writes the uniforms, and records the depth
    /// pass if it is needed.
    ///
    /// The encoder must be submitted before any work that samples these shadows, and encoders must
    /// be submitted in the order in which they were recorded ([what a kept map relies
    /// on](crate#what-a-kept-map-relies-on)).
    ///
    /// # Errors
    /// Returns [`ShadowError`] for a position or direction that is not finite, for a direction of
    /// length zero, for an angle or range outside its limits, for a view that cannot be
    /// represented, for casters whose pipelines do not fit the light, and for a device that is lost
    /// or out of memory. Nothing is recorded then, and the map of the last successful frame
    /// remains.
    pub fn record(
        &mut self,
        encoder: &mut wgpu::CommandEncoder,
        frame: &ShadowFrame<'_>,
        light: &SpotLight,
    ) -> Result<&ShadowReport, ShadowError> {
        let light = light.placement(0, 1.0)?;
        self.lights.record(encoder, frame, &[light], None)
    }

    /// Returns the light's depth texture, uniforms and report.
    pub fn maps(&self) -> &ShadowMaps {
        self.lights.maps()
    }

    /// Discards the extents of earlier frames. Without this call, extents grow at once and shrink
    /// only after some time, so that moving objects do not change the texels of static ones. Call
    /// it where the camera cuts to another scene.
    pub fn reset_history(&mut self) {
        self.lights.reset_history();
    }

    /// Declares the contents of the map invalid ([what a kept map relies
    /// on](crate#what-a-kept-map-relies-on)): the next frame draws it.
    pub fn invalidate(&mut self) {
        self.lights.invalidate();
    }
}

impl SpotLight {
    /// Returns the light's view in slot `slot` of its maps if its position, direction, angle and
    /// range are valid.
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
