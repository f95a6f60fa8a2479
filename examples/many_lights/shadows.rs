//! The sun, a pool of spots, a pool of lamps, and one bind group for all of them.

use std::error::Error;

use glam::DVec3;
use wgpu_shadows::{
    Coverage, DirectionalFrame, DirectionalLight, DirectionalShadow, DirectionalShadowDescriptor,
    OmniShadowPool, PoolDescriptor, PoolFrame, PoolLight, ShadowBindings, ShadowBindingsDescriptor,
    ShadowCaster, ShadowReport, ShadowSlot, SpotShadowPool,
};

use crate::common::camera::Camera;
use crate::lights::{LAMPS, Lights, SPOTS, TOWARD_SUN};

pub struct Shadows {
    sun: DirectionalShadow,
    spots: SpotShadowPool,
    spot_slots: Vec<ShadowSlot>,
    lamps: OmniShadowPool,
    lamp_slots: Vec<ShadowSlot>,
    bindings: ShadowBindings,
    moving_spots: Vec<bool>,
    moving_lamps: Vec<bool>,
}

impl Shadows {
    pub fn new(device: &wgpu::Device) -> Result<Self, Box<dyn Error>> {
        let sun = DirectionalShadow::new(
            device,
            &DirectionalShadowDescriptor {
                label: Some("sun"),
                ..Default::default()
            },
        )?;
        let pool = |label, capacity, map_size| PoolDescriptor {
            label: Some(label),
            capacity,
            map_size,
            ..Default::default()
        };
        let mut spots = SpotShadowPool::new(device, &pool("spots", SPOTS as u32, 512))?;
        let mut lamps = OmniShadowPool::new(device, &pool("lamps", LAMPS as u32, 256))?;
        let spot_slots = (0..SPOTS)
            .map(|_| spots.insert())
            .collect::<Result<_, _>>()?;
        let lamp_slots = (0..LAMPS)
            .map(|_| lamps.insert())
            .collect::<Result<_, _>>()?;
        let bindings = ShadowBindings::new(
            device,
            &ShadowBindingsDescriptor {
                lights: &[
                    ("sun", sun.source()),
                    ("spots", spots.source()),
                    ("lamps", lamps.source()),
                ],
                ..Default::default()
            },
        )?;
        Ok(Self {
            sun,
            spots,
            spot_slots,
            lamps,
            lamp_slots,
            bindings,
            moving_spots: Vec::new(),
            moving_lamps: Vec::new(),
        })
    }

    pub fn bindings(&self) -> &ShadowBindings {
        &self.bindings
    }

    /// Depth passes of what has changed; of the lamps no more than `budget` views.
    pub fn record(
        &mut self,
        device: &wgpu::Device,
        encoder: &mut wgpu::CommandEncoder,
        lights: &Lights,
        camera: &Camera,
        casters: &[&dyn ShadowCaster],
        budget: Option<u32>,
    ) -> Result<(), Box<dyn Error>> {
        let view = camera.for_shadows();
        let frame = DirectionalFrame {
            origin: DVec3::ZERO,
            light: DirectionalLight::new(-TOWARD_SUN),
            coverage: Coverage::Camera(view),
            casters,
            receivers: &[],
        };
        self.sun.record(device, encoder, &frame)?;

        let spots: Vec<_> = self
            .spot_slots
            .iter()
            .zip(&lights.spots)
            .map(|(slot, spot)| PoolLight {
                slot: *slot,
                light: spot.light(),
                importance: 1.0,
            })
            .collect();
        let frame = PoolFrame {
            origin: DVec3::ZERO,
            lights: &spots,
            camera: Some(view),
            casters,
            receivers: &[],
            max_views: None,
        };
        self.spots.record(device, encoder, &frame)?;

        let lamps: Vec<_> = self
            .lamp_slots
            .iter()
            .zip(&lights.lamps)
            .map(|(slot, lamp)| PoolLight {
                slot: *slot,
                light: lamp.light(),
                // What is closer fills more of the picture.
                importance: camera.eye.distance(lamp.place).max(1.0).recip(),
            })
            .collect();
        let frame = PoolFrame {
            origin: DVec3::ZERO,
            lights: &lamps,
            camera: Some(view),
            casters,
            receivers: &[],
            max_views: budget,
        };
        self.lamps.record(device, encoder, &frame)?;
        self.moving_spots = lights.spots.iter().map(|spot| spot.moves).collect();
        self.moving_lamps = lights.lamps.iter().map(|lamp| lamp.moves).collect();
        Ok(())
    }

    /// Each set of maps: its name, its report, views per light, and which of its lights move (none for a sun that does not).
    pub fn reports(&self) -> [(&str, &ShadowReport, usize, &[bool]); 3] {
        [
            ("sun", self.sun.report(), 1, &[]),
            ("spots", self.spots.report(), 1, &self.moving_spots),
            ("lamps", self.lamps.report(), 6, &self.moving_lamps),
        ]
    }
}
