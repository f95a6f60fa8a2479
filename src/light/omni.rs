//! Defines `OmniShadow`: the shadows of a light that shines in every direction.

use glam::DVec3;

use crate::check;
use crate::fit::LightAxes;
use crate::light::local::{LocalLights, LocalPlacement};
use crate::receive::{
    Sampling, Selection, ShadowMaps, ShadowMapsDescriptor, check_bias, check_fade, check_filter,
};
use crate::{Bias, Filter, ShadowError, ShadowFrame, report::ShadowReport};

/// Describes what an [`OmniShadow`] is made of. [`OmniShadow::new`] returns
/// [`ShadowError::OutOfRange`] for values outside the ranges given here, and
/// [`ShadowError::OverDeviceLimit`] for those beyond the device's limits.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OmniShadowDescriptor<'a> {
    /// Is the label from which all wgpu objects of the light derive theirs; "omni shadow" if
    /// `None`, the default.
    pub label: wgpu::Label<'a>,
    /// Is the number of texels per side of each of the six faces: from 1 to the device's
    /// `max_texture_dimension_2d`. The default is 1024. Cost and memory grow with its square; the
    /// blur and the displacement of an edge shrink in proportion to it.
    pub map_size: u32,
    /// Selects how a map is sampled. The default is that of [`Filter`]. Every filter is accepted.
    pub filter: Filter,
    /// Selects how receivers are kept from shadowing themselves. The default is [`Bias::Auto`].
    pub bias: Bias,
    /// Is the fraction of a light's range, in 0..=1, over which shadows fade to light before they
    /// end there. The default is 0: they end at once.
    pub fade: f32,
}

impl Default for OmniShadowDescriptor<'_> {
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

/// Describes a light at a position that shines in every direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OmniLight {
    /// Is the absolute world position (f64), finite. It may lie anywhere, even on a surface or on a
    /// vertex. The near plane of each face is at the bounds of the nearest caster, but no nearer
    /// than 1/1024 of half their largest side. Where bounds contain the light, as those of a lamp
    /// shade, of a room or of a whole scene do, it is at 1/16 of half their smallest side, or at
    /// the distance that costs half a texel of contact at the farthest receiver that is seen
    /// (1/8192 of that receiver's distance in maps of 1024 texels), whichever is farther. No limit
    /// is more than 1/1024 of the distance to that receiver. What lies before the near plane casts
    /// nothing.
    pub position_world: DVec3,
    /// Is the distance in world units beyond which the light neither draws casters nor shadows
    /// receivers: above 0, infinity allowed. Beyond it visibility is 1, and the engine's
    /// attenuation should be 0. Too small a value leaves lit surfaces without shadows; too large a
    /// value draws casters whose shadows nobody sees. An end that is far away costs no precision:
    /// maps are fitted to what is seen within it.
    pub range: f32,
}

/// Renders the shadows of a point light: six perspective faces, which are layers of one depth
/// texture.
///
/// # One pass or a pass for each face
/// On a device with `Features::MULTIVIEW` and a `Limits::max_multiview_view_count` of 6 or more,
/// the six faces can be drawn in one multiview pass; on any other device each face takes a pass.
/// Both ways give the same depths. One pass draws each caster once, into all six faces. It saves
/// passes and draw calls, but transforms every triangle for six faces instead of only for those
/// that the caster touches. It is used for a frame in which
///
/// - each face that something casts into is drawn completely: no face is kept, and none is copied
///   from a static-caster cache;
/// - every caster has a built-in vertex stage
///   ([`CasterVertex::BuiltIn`](crate::caster::CasterVertex::BuiltIn)), reports its triangles
///   ([`ShadowCaster::triangles`](crate::ShadowCaster::triangles)) and draws the same into every
///   view ([`ShadowCaster::same_in_every_view`](crate::ShadowCaster::same_in_every_view)), as
///   [`MeshCaster`](crate::MeshCaster) does;
/// - no caster goes on beyond the farthest receiver that is seen within the light's range into a
///   face that its nearer part does not touch;
/// - 6 × the triangles of all casters < 4000 × the passes saved + 96 × the draw calls saved. All
///   copies of a mesh in a face ([`ShadowCaster::instances`](crate::ShadowCaster::instances)) are
///   one call.
///
/// The constants were measured by `cargo bench --bench cost` ("one pass for all faces") on a
/// software rasterizer, where triangles cost more in relation to calls than on a GPU; a GPU would
/// profit from one pass for more triangles as well. A room with a few objects is drawn in one pass,
/// a detailed scene is not. Lights of a pool always take a pass for each face. So do all lights on
/// Mesa's llvmpipe before 25.0.7, which draws clipped triangles of one pass into wrong faces.
/// [`ShadowReport::passes`] tells how many passes a frame took.
#[derive(Debug)]
pub struct OmniShadow {
    lights: LocalLights,
}

impl OmniShadow {
    /// Creates the light's texture and buffers. Until the first [`OmniShadow::record`], every
    /// surface is lit.
    ///
    /// # Errors
    /// Returns [`ShadowError`] for a descriptor with a value out of range, and for a device whose
    /// limits or memory do not suffice or that is lost.
    pub fn new(
        device: &wgpu::Device,
        descriptor: &OmniShadowDescriptor<'_>,
    ) -> Result<Self, ShadowError> {
        check_filter("OmniShadowDescriptor::filter", descriptor.filter)?;
        check_bias("OmniShadowDescriptor::bias", descriptor.bias)?;
        check_fade("OmniShadowDescriptor::fade", descriptor.fade)?;
        let lights = LocalLights::new(
            device,
            &ShadowMapsDescriptor {
                label: descriptor.label.unwrap_or("omni shadow"),
                map_size: descriptor.map_size,
                size_field: "OmniShadowDescriptor::map_size",
                lights: 1,
                layers_field: "the six faces of an OmniShadow",
                sampling: Sampling {
                    fade: descriptor.fade,
                    ..Sampling::new(descriptor.filter, descriptor.bias)
                },
                views_per_light: 6,
                selection: Selection::CubeFace,
                shares_layer: false,
                indexed: false,
            },
        )?;
        Ok(Self { lights })
    }

    /// Fits the faces to the frame, culls the casters, writes the uniforms, and records the depth
    /// passes that are needed. A face into which nothing casts, or on which no visible receiver
    /// lies, is neither drawn nor cleared.
    ///
    /// The encoder must be submitted before any work that samples these shadows, and encoders must
    /// be submitted in the order in which they were recorded ([what a kept map relies
    /// on](crate#what-a-kept-map-relies-on)).
    ///
    /// # Errors
    /// Returns [`ShadowError`] for a position that is not finite, for a range that is not above 0,
    /// for a view that cannot be represented, for casters whose pipelines do not fit the light, and
    /// for a device that is lost or out of memory. Nothing is recorded then, and the maps of the
    /// last successful frame remain.
    pub fn record(
        &mut self,
        encoder: &mut wgpu::CommandEncoder,
        frame: &ShadowFrame<'_>,
        light: &OmniLight,
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

    /// Declares the contents of the maps invalid ([what a kept map relies
    /// on](crate#what-a-kept-map-relies-on)): the next frame draws every view.
    pub fn invalidate(&mut self) {
        self.lights.invalidate();
    }
}

impl OmniLight {
    /// Returns the light's views in slot `slot` of its maps if its position and range are valid.
    pub(crate) fn placement(
        &self,
        slot: u32,
        importance: f32,
    ) -> Result<LocalPlacement, ShadowError> {
        check::finite_vector("OmniLight::position_world", self.position_world)?;
        check::above_zero("OmniLight::range", self.range)?;
        Ok(LocalPlacement {
            slot,
            position_world: self.position_world,
            range: self.range,
            axes: cube_faces(),
            view_count: 6,
            tangent: 1.0,
            cone_cosine: -2.0,
            importance,
        })
    }
}

/// Returns the axes of the faces +x, -x, +y, -y, +z, -z. Their up vectors are those of a cross that
/// is unfolded around -z: the four sides are upright, and top and bottom join the side that looks
/// along -z.
fn cube_faces() -> [LightAxes; 6] {
    [
        (DVec3::X, DVec3::Y),
        (DVec3::NEG_X, DVec3::Y),
        (DVec3::Y, DVec3::Z),
        (DVec3::NEG_Y, DVec3::NEG_Z),
        (DVec3::Z, DVec3::Y),
        (DVec3::NEG_Z, DVec3::Y),
    ]
    .map(|(forward, up)| LightAxes::looking(forward, up))
}
