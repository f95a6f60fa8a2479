//! Owns the point light's shadows, and draws the images that they are in.

use std::error::Error;

use example_support::map_picture;
use example_support::phong::{Batch, Lighting, Phong, PhongDescriptor, Picture};
use glam::{DVec3, Vec3};
use shadow_support::gpu::Gpu;
use shadow_support::readback;
use wgpu_shadows::{
    Casters, Coverage, Filter, OmniLight, OmniShadow, OmniShadowDescriptor, ShadowBindings,
    ShadowBindingsDescriptor, ShadowCaster, ShadowError, ShadowFrameDescriptor, ShadowScene,
    debug::DebugImage, report::ShadowReport,
};

use crate::SIZE;
use crate::room::{self, Room};

/// Is the number of texels per side of each face.
pub const MAP_SIZE: u32 = 1024;

/// Is the distance at which the light ends.
const RANGE: f32 = 15.0;

const PICTURE_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8UnormSrgb;

/// Holds a point light that casts shadows, and the pass that samples them.
pub struct Lamp {
    shadow_scene: ShadowScene,
    shadow: OmniShadow,
    bindings: ShadowBindings,
    phong: Phong,
}

impl Lamp {
    pub fn new(gpu: &Gpu, filter: Filter) -> Result<Self, Box<dyn Error>> {
        let shadow = OmniShadow::new(
            &gpu.device,
            &OmniShadowDescriptor {
                label: Some("lamp"),
                map_size: MAP_SIZE,
                filter,
                ..Default::default()
            },
        )?;
        let bindings = ShadowBindings::new(
            &gpu.device,
            &ShadowBindingsDescriptor {
                lights: &[("lamp", shadow.maps())],
                ..Default::default()
            },
        )?;
        let phong = Phong::new(
            gpu,
            &PhongDescriptor {
                visibility_wgsl: bindings.wgsl(),
                fragment_wgsl: include_str!("room.wgsl"),
                fragment_entry: "fragment",
                shadow_group: bindings.group(),
                shadow_layout: bindings.layout(),
                format: PICTURE_FORMAT,
                sample_count: 4,
            },
        );
        Ok(Self {
            shadow_scene: ShadowScene::new(),
            shadow,
            bindings,
            phong,
        })
    }

    /// Returns what the last frame cost.
    pub fn report(&self) -> &ShadowReport {
        self.shadow.maps().report()
    }

    /// Draws the image of the room with the light at `place`: depth passes of what the camera
    /// needs, then the scene.
    pub fn draw(
        &mut self,
        gpu: &Gpu,
        room: &Room,
        place: Vec3,
        casters: &[&dyn ShadowCaster],
    ) -> Result<Vec<u8>, Box<dyn Error>> {
        let camera = room::camera(SIZE);
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        let cameras = [camera.view];
        let seen = Coverage::Cameras(&cameras);
        self.record(&mut encoder, room, place, seen, casters)?;

        let lighting = Lighting {
            light: place.extend(1.0),
            light_color: Vec3::new(1.0, 0.96, 0.88),
            light_range: RANGE,
            ambient: Vec3::splat(0.12),
            sky: Vec3::ZERO,
        };
        let bulb = room::bulb(&gpu.device, place);
        let target = gpu.target(PICTURE_FORMAT, SIZE, 1);
        self.phong.draw(
            gpu,
            &mut encoder,
            &Picture {
                camera: &camera,
                lighting: &lighting,
                shadows: self.bindings.bind_group(),
                target: &target,
            },
            room.objects().chain([&bulb]).map(Batch::from),
        );
        Ok(readback::texels(gpu, encoder, &target)?)
    }

    /// Fills all faces, whatever a camera would see of them.
    pub fn record_for_all_of_space(
        &mut self,
        gpu: &Gpu,
        room: &Room,
        place: Vec3,
        casters: &[&dyn ShadowCaster],
    ) -> Result<(), ShadowError> {
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        self.record(&mut encoder, room, place, Coverage::Everything, casters)?;
        gpu.queue.submit([encoder.finish()]);
        Ok(())
    }

    /// Draws the map as the last frame left it.
    pub fn draw_map(
        &self,
        gpu: &Gpu,
        picture: DebugImage,
        size: [u32; 2],
    ) -> Result<Vec<u8>, Box<dyn Error>> {
        let encoder = gpu.device.create_command_encoder(&Default::default());
        map_picture::draw(gpu, encoder, self.shadow.maps(), picture, size)
    }

    fn record(
        &mut self,
        encoder: &mut wgpu::CommandEncoder,
        room: &Room,
        place: Vec3,
        coverage: Coverage<'_>,
        casters: &[&dyn ShadowCaster],
    ) -> Result<(), ShadowError> {
        let frame = self.shadow_scene.frame(&ShadowFrameDescriptor {
            origin: DVec3::ZERO,
            coverage,
            casters: Casters::List(casters),
            receivers: &room.walls(),
        })?;
        let light = OmniLight {
            position_world: place.as_dvec3(),
            range: RANGE,
        };
        self.shadow.record(encoder, &frame, &light)?;
        Ok(())
    }
}
