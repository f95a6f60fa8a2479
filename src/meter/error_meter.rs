//! Defines `ErrorMeter`, which compares a light's shadows with rays through its own casters.

use crate::cast::RayPass;
use crate::check;
use crate::gpu::StagedUploads;
use crate::meter::light::MeasuredLight;
use crate::meter::limits::check_limits;
use crate::meter::lookup::{Lookup, RESULT_BYTES};
use crate::meter::measured::{MeasuredError, MeterReport};
use crate::meter::places::{Place, Places, RAYS_PER_PLACE, RaySetting, Receiver};
use crate::meter::random::Random;
use crate::meter::readback::Readback;
use crate::meter::results::Results;
use crate::receive::ShadowMaps;
use crate::{ShadowError, ShadowFrame};

/// Describes what an [`ErrorMeter`] is made of.
#[derive(Clone, Copy, Debug)]
pub struct ErrorMeterDescriptor<'a> {
    /// Is the label from which all wgpu objects of the meter derive theirs; "shadow error meter" if
    /// `None`.
    pub label: wgpu::Label<'a>,
    /// Holds the maps of the light, or of the pool, that is measured: what its `maps` method
    /// returns.
    pub maps: &'a ShadowMaps,
    /// Is the largest number of places that a frame measures: 1..=4096. 64 suit a running scene.
    /// The cost of a frame is proportional to it, and the width of the confidence intervals to the
    /// reciprocal of its square root.
    pub places_per_frame: u32,
    /// Is the number of frames after which a place counts `1/e` as much as a new one; at least 1.
    /// With 64 of 64 places each the estimates are worth 8192 places, and an error that begins
    /// shows within few frames. A larger number makes the intervals narrower and the meter slower
    /// to notice a change.
    pub window_frames: u32,
}

impl<'a> ErrorMeterDescriptor<'a> {
    /// Describes a meter of 64 places a frame, with a window of 64 frames.
    pub const fn new(maps: &'a ShadowMaps) -> Self {
        Self {
            label: None,
            maps,
            places_per_frame: 64,
            window_frames: 64,
        }
    }
}

/// Measures the error of a light's shadows in a running scene, with rays through the engine's own
/// casters.
///
/// Each frame it compares, at some places of the surfaces that are seen, the visibility that the
/// light's lookup returns with a ray to the light. The ray is cast by the rasterizer: a view whose
/// map is one texel around the ray is drawn through the engine's
/// [`ShadowCaster`](crate::ShadowCaster)s with their own pipelines, so what skinning, displacement
/// and alpha masks do is in it. The texel is covered exactly where a triangle meets the ray. It
/// needs no ray-tracing hardware, no second copy of the scene, and no depth pipeline that the
/// engine has not.
///
/// So it notices what a map alone cannot tell: maps that were kept although a caster moved, casters
/// that are missing from a light's frame, a bias that is too large or too small, and resolution
/// that does not suffice.
///
/// ```no_run
/// # use wgpu_shadows::*;
/// # use wgpu_shadows::meter::*;
/// # fn frame(device: &wgpu::Device, queue: &wgpu::Queue, sun: &mut DirectionalShadow,
/// #     frame: &ShadowFrame<'_>, light: &DirectionalLight, receivers: &[Receiver])
/// #     -> Result<(), ShadowError> {
/// // At load time:
/// let mut meter = ErrorMeter::new(&ErrorMeterDescriptor::new(sun.maps()))?;
///
/// // In every frame, after the light, in the same encoder:
/// let mut encoder = device.create_command_encoder(&Default::default());
/// sun.record(&mut encoder, frame, light)?;
/// let light = MeasuredLight::Directional(light);
/// meter.record(&mut encoder, frame, sun.maps(), &light, receivers)?;
/// queue.submit([encoder.finish()]);
///
/// // At any time: what the results that have arrived so far tell.
/// let measured = meter.measured();
/// println!("rmse {:.3}, at most {:.3}", measured.rmse.value, measured.rmse.high);
/// # Ok(())
/// # }
/// ```
///
/// # Which places
/// The engine gives places of what its camera sees, drawn at random in each frame: pixels of a
/// low-resolution image traced on the CPU, or points of the meshes' triangles. The estimates are
/// means over the places that are given, so a choice that favours some surfaces is a choice of what
/// the error is a mean of. The intervals assume that places are drawn independently; places that
/// are spread more evenly than that make them too wide.
///
/// # What counts as the truth
/// Rays meet what the casters draw at the finest level of detail (a
/// [`ShadowView`](crate::ShadowView) with tiny texels is passed to their `draw`), with their
/// pipelines' culling. A light whose filter has a size ([`Filter::Pcss`](crate::Filter::Pcss)) is
/// asked at two random points for each place. Where shadows end by a setting (a camera's distance
/// limit, a fade), the shadow that is missing counts as false light.
///
/// A ray is as exact as f32 positions are at the farthest corner of the bounds that it meets. Where
/// that is coarser than the map's texel at the receiver, the place is left out and counted in
/// [`MeterReport`]; something tiny between a receiver and a lamp, under bounds of hundreds of
/// kilometres, can still be measured wrongly.
///
/// # Results
/// Results are mapped when the encoder's submission is done, and the engine's own submissions or
/// polls notice that; nothing waits. While the results of four frames are on their way, frames are
/// not measured.
#[derive(Debug)]
pub struct ErrorMeter {
    label: String,
    device: wgpu::Device,
    /// Identifies the maps that the lookup binds.
    texture: wgpu::Texture,
    places_per_frame: u32,
    places: Places,
    rays: RayPass,
    lookup: Lookup,
    readback: Readback<FrameOfPlaces>,
    random: Random,
    results: Results,
    report: MeterReport,
}

/// Is what a frame remembers until its results arrive.
#[derive(Debug)]
struct FrameOfPlaces {
    places: Vec<Place>,
    /// Is the number of resets before it.
    resets: u64,
}

impl ErrorMeter {
    /// Creates the meter's buffers, its texture of a texel per ray, and its compute pipeline.
    ///
    /// # Errors
    /// Returns [`ShadowError`] for a number outside its range, and for a device whose limits do not
    /// suffice (WebGL 2 has no compute shaders) or that is lost or out of memory.
    pub fn new(descriptor: &ErrorMeterDescriptor<'_>) -> Result<Self, ShadowError> {
        let places = descriptor.places_per_frame;
        let field = "ErrorMeterDescriptor::places_per_frame";
        check::in_range(field, "in 1..=4096", (1..=4096).contains(&places), places)?;
        check::in_range(
            "ErrorMeterDescriptor::window_frames",
            "at least 1",
            descriptor.window_frames >= 1,
            descriptor.window_frames,
        )?;
        let maps = descriptor.maps;
        let device = maps.device();
        check_limits(device, field, places)?;
        let label = descriptor.label.unwrap_or("shadow error meter");
        let format = maps.sampling().depth_format;
        let most_rays = places * RAYS_PER_PLACE as u32;
        let rays = RayPass::new(device, label, field, most_rays, format)?;
        let result_bytes = RESULT_BYTES * u64::from(places);
        Ok(Self {
            label: label.to_owned(),
            device: device.clone(),
            texture: maps.texture().clone(),
            places_per_frame: places,
            places: Places::default(),
            lookup: Lookup::new(maps, label, places, rays.map())?,
            rays,
            readback: Readback::new(device, label, result_bytes)?,
            random: Random::default(),
            results: Results::new(descriptor.window_frames),
            report: MeterReport::default(),
        })
    }

    /// Measures the first of `receivers` that can be measured, up to
    /// [`places_per_frame`](ErrorMeterDescriptor::places_per_frame): those that face the light and
    /// that it reaches. Records a pass that draws their rays, a compute pass that asks the light's
    /// lookup, and a copy.
    ///
    /// The light must have been recorded into the same encoder or one submitted before, with the
    /// same `frame` and `light`; `maps` are its own. With another frame the meter measures what
    /// this frame's surfaces would see of those maps, which is how a frame that lacks a caster can
    /// be checked against a complete one.
    ///
    /// # Errors
    /// Returns [`ShadowError`] for maps or a light of another kind than those of the meter, for
    /// positions or vectors that are not finite or are zero, for casters whose pipelines do not fit
    /// the light, and for a device that is lost or out of memory. Nothing is recorded then.
    pub fn record(
        &mut self,
        encoder: &mut wgpu::CommandEncoder,
        frame: &ShadowFrame<'_>,
        maps: &ShadowMaps,
        light: &MeasuredLight<'_>,
        receivers: &[Receiver],
    ) -> Result<&MeterReport, ShadowError> {
        check::in_range(
            "ErrorMeter::record: maps",
            "those of ErrorMeterDescriptor::maps",
            *maps.texture() == self.texture,
            "the maps of another light",
        )?;
        light.check(maps)?;
        self.collect();
        let setting = RaySetting {
            frame,
            maps,
            light,
            map_size: self.rays.map().size(),
            most_places: self.places_per_frame as usize,
        };
        let report = self.places.choose(&setting, receivers, &mut self.random)?;
        if !self.readback.has_room() || self.places.places.is_empty() {
            self.report = MeterReport {
                places: 0,
                rays: 0,
                ..report
            };
            return Ok(&self.report);
        }
        self.record_places(encoder, frame, report)
    }

    fn record_places(
        &mut self,
        encoder: &mut wgpu::CommandEncoder,
        frame: &ShadowFrame<'_>,
        report: MeterReport,
    ) -> Result<&MeterReport, ShadowError> {
        let Places {
            places,
            uniforms,
            rays,
            met,
        } = &self.places;
        let prepared = self.rays.prepare(&self.device, rays, met, &frame.casters)?;
        let mut uploads = vec![self.lookup.upload(uniforms)];
        self.rays.add_uploads(&mut uploads);
        let staged = StagedUploads::new(&self.device, &uploads)?;
        // Nothing fails from here on.
        staged.commit(encoder, &uploads);
        let cost = self.rays.record(encoder, &prepared, rays, &frame.casters);
        let count = places.len() as u32;
        self.lookup.record(encoder, &self.label, count);
        let frame_of_places = FrameOfPlaces {
            places: places.clone(),
            resets: self.results.resets(),
        };
        let bytes = RESULT_BYTES * u64::from(count);
        let results = self.lookup.results();
        self.readback
            .record(encoder, results, bytes, frame_of_places);
        self.report = MeterReport {
            draws: cost.draws,
            triangles: cost.triangles,
            passes: 2,
            ..report
        };
        Ok(&self.report)
    }

    /// Returns the error by the results that have arrived.
    pub fn measured(&mut self) -> MeasuredError {
        self.collect();
        self.results.measured()
    }

    /// Returns the places of the last frame whose results have arrived.
    pub fn last_places(&self) -> &[crate::meter::MeasuredPlace] {
        self.results.last_places()
    }

    /// Returns what the meter did in the last frame.
    pub fn report(&self) -> &MeterReport {
        &self.report
    }

    /// Forgets all results, those that are on their way as well: after a cut to another scene, or
    /// when a setting of the light changes.
    pub fn reset(&mut self) {
        self.results.reset();
    }

    /// Declares the meter's uniform buffers unwritten. Call it when an encoder was dropped that the
    /// meter had been recorded into.
    pub fn invalidate(&mut self) {
        self.rays.invalidate();
    }

    fn collect(&mut self) {
        let results = &mut self.results;
        self.readback.collect(|frame: FrameOfPlaces, bytes| {
            if frame.resets == results.resets() {
                results.add_frame(&frame.places, bytes);
            }
        });
    }
}
