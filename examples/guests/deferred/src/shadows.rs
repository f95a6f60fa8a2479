//! Faces `wgpu-shadows`: a sun, a spot light and a lamp, and the casters of the scene.

use std::error::Error;

use wgpu_shadows::{glam::DVec3, *};

use crate::scene::{Lights, Scene};

/// Owns the lights' shadows, and the casters in the order of the scene's objects.
pub struct Shadows {
    scene: ShadowScene,
    casters: CasterSet<MeshCaster>,
    ids: Vec<CasterId>,
    sun: DirectionalShadow,
    spot: SpotShadow,
    lamp: OmniShadow,
    pub bindings: ShadowBindings,
}

impl Shadows {
    pub fn new(device: &wgpu::Device, scene: &Scene) -> Result<Self, Box<dyn Error>> {
        let mut casters = CasterSet::new();
        let sun = DirectionalShadow::new(device, &Default::default())?;
        let spot = SpotShadow::new(device, &Default::default())?;
        let lamp = OmniShadow::new(device, &Default::default())?;
        Ok(Self {
            bindings: ShadowBindings::new(
                device,
                &ShadowBindingsDescriptor {
                    group: 1,
                    visibility: wgpu::ShaderStages::COMPUTE,
                    lights: &[
                        ("sun", sun.maps()),
                        ("spot", spot.maps()),
                        ("lamp", lamp.maps()),
                    ],
                    ..Default::default()
                },
            )?,
            ids: casters.insert_all(scene.casters(device)?),
            scene: ShadowScene::new(),
            casters,
            sun,
            spot,
            lamp,
        })
    }

    /// Records what changed since the last frame.
    pub fn record(
        &mut self,
        encoder: &mut wgpu::CommandEncoder,
        scene: &Scene,
        camera: CameraView,
        lights: &Lights,
    ) -> Result<(), Box<dyn Error>> {
        for &moved in &scene.moved {
            let place = scene.objects[moved].render_from_model;
            self.casters
                .update(self.ids[moved], |caster| caster.set_transform(place))??;
        }
        let frame = self.scene.frame(&ShadowFrameDescriptor {
            origin: DVec3::ZERO,
            coverage: Coverage::Cameras(&[camera]),
            casters: Casters::Set(&self.casters),
            receivers: &[],
        })?;
        self.sun.record(encoder, &frame, &lights.sun)?;
        self.spot.record(encoder, &frame, &lights.spot)?;
        self.lamp.record(encoder, &frame, &lights.lamp)?;
        Ok(())
    }

    /// Makes the next frame draw everything.
    pub fn invalidate(&mut self) {
        self.sun.invalidate();
        self.spot.invalidate();
        self.lamp.invalidate();
    }

    /// Returns the passes of the last frame and the bytes of all maps.
    pub fn totals(&self) -> (u32, u64) {
        let maps = [self.sun.maps(), self.spot.maps(), self.lamp.maps()];
        let reports = maps.map(ShadowMaps::report);
        (
            reports.iter().map(|report| report.passes).sum(),
            reports.iter().map(|report| report.bytes_held).sum(),
        )
    }
}
