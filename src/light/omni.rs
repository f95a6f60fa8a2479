//! `OmniShadow`: a light that shines in every direction.

use glam::DVec3;

use crate::check;
use crate::fit::LightAxes;
use crate::light::layer_limits::check_layers;
use crate::light::local::{LocalLights, LocalPlacement};
use crate::receive::{
    Sampling, Selection, ShadowMaps, ShadowMapsDescriptor, check_bias, check_filter,
};
use crate::{Bias, Filter, ShadowError, ShadowFrame, report::ShadowReport};

/// What an [`OmniShadow`] is made of.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OmniShadowDescriptor<'a> {
    /// Label from which all objects derive theirs. Default "omni shadow".
    pub label: wgpu::Label<'a>,
    /// Texels per side of each of the six faces, 1 up to the device's `max_texture_dimension_2d`. Default 1024.
    pub map_size: u32,
    /// How a map is looked up.
    pub filter: Filter,
    /// How receivers are kept from shadowing themselves.
    pub bias: Bias,
}

impl Default for OmniShadowDescriptor<'_> {
    fn default() -> Self {
        Self {
            label: None,
            map_size: 1024,
            filter: Filter::default(),
            bias: Bias::Auto,
        }
    }
}

/// A light at a place that shines in every direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OmniLight {
    /// Absolute world position (f64). It may lie anywhere, on a surface or on a vertex included. The near plane of each face
    /// is at the bounds of the nearest caster, but no nearer than 1/1024 of half their largest side. Where bounds contain the
    /// light, as those of a lamp shade or of a room do, it is at 1/16 of half their smallest side. Both limits are at most
    /// 1/1024 of the distance to the farthest receiver that is seen. What lies before the near plane casts nothing.
    pub position_world: DVec3,
    /// Distance in world units beyond which the light neither draws casters nor shadows receivers (visibility is 1 there, and
    /// the engine's attenuation should be 0); above 0, infinity allowed. An end that is far away costs no precision: maps are
    /// fitted to what is seen within it.
    pub range: f32,
}

/// Shadows of a point light: six perspective faces as layers of one depth texture.
///
/// # One pass or a pass for each face
/// On a device with `Features::MULTIVIEW` and `Limits::max_multiview_view_count` of 6 or more, the faces can be drawn in one pass;
/// on every other in a pass for each. Both give the same depths. One pass draws each caster once, into all six faces: it saves
/// passes and draw calls, and puts every triangle through six faces instead of those that the caster touches. It is taken for a
/// frame in which
///
/// - each face that anything casts into is drawn whole: none is kept, and none is made from what stands still;
/// - every caster has a built-in vertex stage ([`CasterVertex::BuiltIn`](crate::caster::CasterVertex::BuiltIn)), tells its triangles
///   ([`ShadowCaster::triangles`](crate::ShadowCaster::triangles)) and draws the same into every view ([`ShadowCaster::same_in_every_view`](crate::ShadowCaster::same_in_every_view)), as
///   [`MeshCaster`](crate::MeshCaster) does;
/// - no caster goes on beyond the farthest receiver that is seen within the light's range into a face that its nearer part
///   does not touch;
/// - 6 × the triangles of all casters < 4000 × the passes saved + 96 × the draw calls saved.
///
/// The figures were measured by `cargo bench --bench cost` ("one pass for all faces") in software, where triangles are dear
/// beside calls; a GPU would gain from more of them. A room with a few things in it is drawn in one pass, a detailed scene is
/// not. Lights of a pool are always drawn in a pass for each face. Mesa's llvmpipe before 25.0.7 draws clipped triangles of one
/// pass into wrong faces, and always gets a pass for each. [`ShadowReport::passes`] tells which it was.
#[derive(Debug)]
pub struct OmniShadow {
    maps: ShadowMaps,
    lights: LocalLights,
}

impl OmniShadow {
    /// Makes texture and buffers. Until the first [`OmniShadow::record`], everything is lit.
    ///
    /// # Errors
    /// [`ShadowError`] for a descriptor out of range, or a device that cannot hold it.
    pub fn new(
        device: &wgpu::Device,
        descriptor: &OmniShadowDescriptor<'_>,
    ) -> Result<Self, ShadowError> {
        check_filter("OmniShadowDescriptor::filter", descriptor.filter)?;
        check_bias("OmniShadowDescriptor::bias", descriptor.bias)?;
        check_layers(device, "the six faces of an OmniShadow", 6)?;
        let maps = ShadowMaps::new(
            device,
            &ShadowMapsDescriptor {
                label: descriptor.label.unwrap_or("omni shadow"),
                size_field: "OmniShadowDescriptor::map_size",
                map_size: descriptor.map_size,
                layers: 6,
                sampling: Sampling::new(descriptor.filter, descriptor.bias),
                selection: Selection::CubeFace,
                views_per_light: 6,
                indexed: false,
            },
        )?;
        Ok(Self {
            maps,
            lights: LocalLights::new(device, 1),
        })
    }

    /// Fits the faces to the frame, culls, writes the uniforms and records the depth passes that are needed: a face into which
    /// nothing casts, or on which no visible receiver lies, is neither drawn nor cleared.
    ///
    /// The encoder must be submitted before anything that asks for these shadows, and encoders in the order in which they were
    /// recorded ([what a kept map relies on](crate#what-a-kept-map-relies-on)).
    ///
    /// # Errors
    /// [`ShadowError`] for input that is not finite, or a range that is not above 0. Nothing is recorded then, and the last
    /// good maps remain.
    pub fn record(
        &mut self,
        encoder: &mut wgpu::CommandEncoder,
        frame: &ShadowFrame<'_>,
        light: &OmniLight,
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

impl OmniLight {
    /// Returns the light in a slot of its maps if its numbers are sound.
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

/// Axes of the faces +x, -x, +y, -y, +z, -z. Their up vectors are those of a cross unfolded around -z: the four sides stand
/// upright, and top and bottom join the side that looks along -z.
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
