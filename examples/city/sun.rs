//! Owns the sun's shadows, and draws the images that they are in.

use std::error::Error;
use std::time::{Duration, Instant};

use example_support::camera::Camera;
use example_support::phong::{Lighting, Phong, PhongDescriptor, Picture};
use example_support::{map_picture, picture};
use glam::{DVec3, Vec3};
use shadow_support::gpu::Gpu;
use shadow_support::readback;
use wgpu_shadows::{
    CascadeLayout, Casters, Coverage, DirectionalLight, DirectionalShadow,
    DirectionalShadowDescriptor, ShadowBindings, ShadowBindingsDescriptor, ShadowCaster,
    ShadowFrameDescriptor, ShadowScene, debug::DebugImage, report::ShadowReport,
};

use crate::density::Density;
use crate::town::Town;

/// Is the number of texels per side of each cascade.
pub const MAP_SIZE: u32 = 2048;

/// Is the number of cascades.
pub const CASCADES: u32 = 4;

/// Points from the town to the sun: some thirty degrees above the roofs, and slightly across the
/// streets.
const TOWARD_SUN: Vec3 = Vec3::new(0.44, 0.52, 0.70);

const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8UnormSrgb;

/// Is the size at which images are drawn: twice their own, and then averaged. Multisampling would
/// shade at the centre of a pixel what only a corner of it shows: at the foot of a lit wall that is
/// pavement inside the house, and dark.
const DRAWN_SIZE: [u32; 2] = [2 * crate::SIZE[0], 2 * crate::SIZE[1]];

/// Selects what an image shows.
#[derive(Clone, Copy)]
pub enum Show {
    Scene,
    /// Shows the scene, tinted by the cascade that covers the pixel.
    Cascades,
}

/// Holds a sun that casts shadows, and the passes that sample them.
pub struct Sun {
    shadow_scene: ShadowScene,
    shadow: DirectionalShadow,
    bindings: ShadowBindings,
    scene: Phong,
    cascades: Phong,
    density: Phong,
    record_time: Duration,
}

impl Sun {
    pub fn new(gpu: &Gpu) -> Result<Self, Box<dyn Error>> {
        let shadow = DirectionalShadow::new(
            &gpu.device,
            &DirectionalShadowDescriptor {
                label: Some("sun"),
                map_size: MAP_SIZE,
                layout: CascadeLayout::fixed(CASCADES),
                ..Default::default()
            },
        )?;
        let bindings = ShadowBindings::new(
            &gpu.device,
            &ShadowBindingsDescriptor {
                lights: &[("sun", shadow.maps())],
                ..Default::default()
            },
        )?;
        let phong = |fragment_entry, format| {
            Phong::new(
                gpu,
                &PhongDescriptor {
                    visibility_wgsl: bindings.wgsl(),
                    fragment_wgsl: include_str!("city.wgsl"),
                    fragment_entry,
                    shadow_group: bindings.group(),
                    shadow_layout: bindings.layout(),
                    format,
                    sample_count: 1,
                },
            )
        };
        Ok(Self {
            shadow_scene: ShadowScene::new(),
            scene: phong("fragment", FORMAT),
            cascades: phong("fragment_cascades", FORMAT),
            density: phong("fragment_density", wgpu::TextureFormat::Rgba8Unorm),
            shadow,
            bindings,
            record_time: Duration::ZERO,
        })
    }

    /// Returns what the last frame cost.
    pub fn report(&self) -> &ShadowReport {
        self.shadow.maps().report()
    }

    /// Returns the CPU time of the last frame's shadows: checks, fit, cull, and the recording of
    /// the passes.
    pub fn record_time(&self) -> Duration {
        self.record_time
    }

    /// Draws the image of the town from `camera`: depth passes, then the scene.
    pub fn draw(
        &mut self,
        gpu: &Gpu,
        town: &Town,
        camera: &Camera,
        casters: &[&dyn ShadowCaster],
        show: Show,
    ) -> Result<Vec<u8>, Box<dyn Error>> {
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        let light = DirectionalLight::new(-TOWARD_SUN);
        let start = Instant::now();
        let frame = self.shadow_scene.frame(&ShadowFrameDescriptor {
            origin: DVec3::ZERO,
            coverage: Coverage::Cameras(&[camera.view]),
            casters: Casters::List(casters),
            receivers: &[town.ground],
        })?;
        self.shadow.record(&mut encoder, &frame, &light)?;
        self.record_time = start.elapsed();

        let target = gpu.target(FORMAT, DRAWN_SIZE, 1);
        let phong = match show {
            Show::Scene => &self.scene,
            Show::Cascades => &self.cascades,
        };
        phong.draw(
            gpu,
            &mut encoder,
            &Picture {
                camera,
                lighting: &lighting(),
                shadows: self.bindings.bind_group(),
                target: &target,
            },
            town.batches(),
        );
        Ok(picture::halved(
            &readback::texels(gpu, encoder, &target)?,
            DRAWN_SIZE,
        ))
    }

    /// Returns how many texels the pixels of the last image cover, for the same `camera`.
    pub fn density(
        &self,
        gpu: &Gpu,
        town: &Town,
        camera: &Camera,
    ) -> Result<Option<Density>, Box<dyn Error>> {
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        let target = gpu.target(wgpu::TextureFormat::Rgba8Unorm, crate::SIZE, 1);
        self.density.draw(
            gpu,
            &mut encoder,
            &Picture {
                camera,
                lighting: &Lighting {
                    sky: Vec3::ZERO,
                    ..lighting()
                },
                shadows: self.bindings.bind_group(),
                target: &target,
            },
            town.batches(),
        );
        Ok(Density::of(&readback::texels(gpu, encoder, &target)?))
    }

    /// Draws the map of one cascade as the last frame left it.
    pub fn draw_map(
        &self,
        gpu: &Gpu,
        layer: u32,
        size: [u32; 2],
    ) -> Result<Vec<u8>, Box<dyn Error>> {
        let encoder = gpu.device.create_command_encoder(&Default::default());
        let layer = DebugImage::Layer(layer);
        map_picture::draw(gpu, encoder, self.shadow.maps(), layer, size)
    }
}

/// Returns the light of a late afternoon.
fn lighting() -> Lighting {
    Lighting {
        light: TOWARD_SUN.normalize().extend(0.0),
        light_color: Vec3::new(1.15, 1.0, 0.80),
        light_range: f32::INFINITY,
        ambient: Vec3::new(0.14, 0.18, 0.25),
        sky: Vec3::new(0.45, 0.58, 0.75),
    }
}
