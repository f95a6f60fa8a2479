//! Owns the sun, a pool of spot lights, a pool of point lights, and one bind group for all of them.

use std::error::Error;

use example_support::camera::Camera;
use example_support::hall::lights::{LAMPS, Lights, SPOTS, TOWARD_SUN};
use glam::DVec3;
use wgpu_shadows::{
    Casters, Coverage, DirectionalLight, DirectionalShadow, DirectionalShadowDescriptor,
    ShadowBindings, ShadowBindingsDescriptor, ShadowCaster, ShadowFrameDescriptor, ShadowScene,
    pool::OmniShadowPool, pool::PoolDescriptor, pool::PoolLight, pool::ShadowSlot,
    pool::SpotShadowPool, report::ShadowReport,
};

pub struct Shadows {
    scene: ShadowScene,
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
        let mut spots = SpotShadowPool::new(device, &pool("spots", SPOTS as u32, 1024))?;
        let mut lamps = OmniShadowPool::new(device, &pool("lamps", LAMPS as u32, 2048))?;
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
                    ("sun", sun.maps()),
                    ("spots", spots.maps()),
                    ("lamps", lamps.maps()),
                ],
                ..Default::default()
            },
        )?;
        Ok(Self {
            scene: ShadowScene::new(),
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

    /// Records the depth passes of what has changed; of the point lights no more than `budget`
    /// views.
    pub fn record(
        &mut self,
        encoder: &mut wgpu::CommandEncoder,
        lights: &Lights,
        camera: &Camera,
        casters: &[&dyn ShadowCaster],
        budget: Option<u32>,
    ) -> Result<(), Box<dyn Error>> {
        // One frame serves all lights: the methods of the casters are called once.
        let frame = self.scene.frame(&ShadowFrameDescriptor {
            origin: DVec3::ZERO,
            coverage: Coverage::Cameras(&[camera.view]),
            casters: Casters::List(casters),
            receivers: &[],
        })?;
        let sun = DirectionalLight::new(-TOWARD_SUN);
        self.sun.record(encoder, &frame, &sun)?;

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
        self.spots.record(encoder, &frame, &spots, None)?;

        let lamps: Vec<_> = self
            .lamp_slots
            .iter()
            .zip(&lights.lamps)
            .map(|(slot, lamp)| PoolLight {
                slot: *slot,
                light: lamp.light(),
                // What is closer fills more of the image.
                importance: camera.eye.distance(lamp.place).max(1.0).recip(),
            })
            .collect();
        self.lamps.record(encoder, &frame, &lamps, budget)?;

        self.moving_spots = lights.spots.iter().map(|spot| spot.moves).collect();
        self.moving_lamps = lights.lamps.iter().map(|lamp| lamp.moves).collect();
        Ok(())
    }

    /// Returns for each set of maps its name, its report, views per light, and which of its lights
    /// move (none for a sun that does not).
    pub fn reports(&self) -> [(&str, &ShadowReport, usize, &[bool]); 3] {
        [
            ("sun", self.sun.maps().report(), 1, &[]),
            ("spots", self.spots.maps().report(), 1, &self.moving_spots),
            ("lamps", self.lamps.maps().report(), 6, &self.moving_lamps),
        ]
    }
}
