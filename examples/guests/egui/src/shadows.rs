//! Faces `wgpu-shadows`: a sun and the casters of the panel.

use std::error::Error;

use example_support::mesh::{Object, copies_pipeline};
use wgpu_shadows::{glam::DVec3, *};

/// Owns the sun's shadows, and the casters in the order of the panel's objects.
pub struct Shadows {
    scene: ShadowScene,
    casters: CasterSet<MeshCaster>,
    ids: Vec<CasterId>,
    pub sun: DirectionalShadow,
    pub bindings: ShadowBindings,
}

impl Shadows {
    pub fn new(device: &wgpu::Device, objects: &[Object]) -> Result<Self, Box<dyn Error>> {
        let pipeline = copies_pipeline(device, &[DepthFormat::Float32])?;
        let casters = objects
            .iter()
            .map(|object| object.caster(device, &pipeline));
        let casters = casters.collect::<Result<Vec<_>, _>>()?;
        let sun = DirectionalShadow::new(device, &DirectionalShadowDescriptor::default())?;
        let mut set = CasterSet::new();
        Ok(Self {
            bindings: ShadowBindings::new(
                device,
                &ShadowBindingsDescriptor {
                    lights: &[("sun", sun.maps())],
                    ..Default::default()
                },
            )?,
            scene: ShadowScene::new(),
            ids: set.insert_all(casters),
            casters: set,
            sun,
        })
    }

    /// Moves one of the objects.
    pub fn place(&mut self, index: usize, object: &Object) -> Result<(), Box<dyn Error>> {
        let place = object.render_from_model;
        self.casters
            .update(self.ids[index], |caster| caster.set_transform(place))??;
        Ok(())
    }

    /// Records what changed since the last frame.
    pub fn record(
        &mut self,
        encoder: &mut wgpu::CommandEncoder,
        camera: CameraView,
        light: &DirectionalLight,
    ) -> Result<(), ShadowError> {
        let frame = self.scene.frame(&ShadowFrameDescriptor {
            origin: DVec3::ZERO,
            coverage: Coverage::Cameras(&[camera]),
            casters: Casters::Set(&self.casters),
            receivers: &[],
        })?;
        self.sun.record(encoder, &frame, light)?;
        Ok(())
    }
}
