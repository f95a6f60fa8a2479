//! Owns the shadows of one side of the picture, and draws the scene with them.

use std::time::Duration;

use example_support::camera::Camera;
use example_support::hall;
use example_support::phong::{Lighting, Phong, PhongDescriptor};
use glam::DVec3;
use shadow_support::gpu::Gpu;
use web_time::Instant;
use wgpu_shadows::{
    Casters, Coverage, DirectionalLight, DirectionalShadow, ShadowBindings,
    ShadowBindingsDescriptor, ShadowFrameDescriptor, ShadowMaps, ShadowScene,
};

use crate::lamps::Lamps;
use crate::scene::Scene;
use crate::settings::{Covers, SideSettings};
use crate::stage::Stage;

/// Is the format of the picture: the shader writes sRGB codes.
pub const PICTURE_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8Unorm;

/// Is the format of visibilities that are read back.
pub const VISIBILITY_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::R32Float;

/// Selects what [`Side::draw`] draws.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Stroke {
    Picture,
    /// Draws the visibility as grey.
    Grey,
    /// Draws the visibility into a target of [`VISIBILITY_FORMAT`].
    Visibility,
}

/// Holds the lights of one setting.
pub struct Side {
    settings: SideSettings,
    sun_radians: f32,
    shadow_scene: ShadowScene,
    sun: DirectionalShadow,
    lamps: Option<Lamps>,
    bindings: ShadowBindings,
    picture: Phong,
    grey: Phong,
    visibility: Phong,
    /// Is the CPU time of the last recording: checks, fit, cull, and the passes.
    pub record_time: Duration,
}

impl Side {
    pub fn new(
        gpu: &Gpu,
        scene: &Scene,
        settings: &SideSettings,
        sun_radians: f32,
    ) -> Result<Self, String> {
        let sun = DirectionalShadow::new(&gpu.device, &settings.sun(sun_radians))
            .map_err(|error| error.to_string())?;
        let lamps = if scene.has_lamps {
            Some(Lamps::new(gpu, settings).map_err(|error| error.to_string())?)
        } else {
            None
        };
        let mut lights = vec![("sun", sun.maps())];
        if let Some(lamps) = &lamps {
            let [spots, lamps] = lamps.maps();
            lights.extend([("spots", spots), ("lamps", lamps)]);
        }
        let bindings = ShadowBindings::new(
            &gpu.device,
            &ShadowBindingsDescriptor {
                lights: &lights,
                ..Default::default()
            },
        )
        .map_err(|error| error.to_string())?;
        let wgsl = fragment_wgsl(scene);
        let phong = |fragment_entry, format| {
            let descriptor = PhongDescriptor {
                visibility_wgsl: bindings.wgsl(),
                fragment_wgsl: &wgsl,
                fragment_entry,
                shadow_group: bindings.group(),
                shadow_layout: bindings.layout(),
                format,
                sample_count: 1,
            };
            Phong::with_lights(gpu, &descriptor, lamps.as_ref().map(Lamps::lights))
        };
        Ok(Self {
            picture: phong("fragment_picture", PICTURE_FORMAT),
            grey: phong("fragment_grey", PICTURE_FORMAT),
            visibility: phong("fragment_visibility", VISIBILITY_FORMAT),
            settings: *settings,
            sun_radians,
            shadow_scene: ShadowScene::new(),
            sun,
            lamps,
            bindings,
            record_time: Duration::ZERO,
        })
    }

    /// Returns whether the lights were made with these settings.
    pub fn is_made_for(&self, settings: &SideSettings, sun_radians: f32) -> bool {
        let makes = |settings: &SideSettings, radians| {
            (settings.sun(radians), settings.lamps(1), settings.spots(1))
        };
        makes(&self.settings, self.sun_radians) == makes(settings, sun_radians)
    }

    /// Takes over what belongs to a frame.
    pub fn set_frame_settings(&mut self, settings: &SideSettings) {
        self.settings = *settings;
    }

    pub fn settings(&self) -> &SideSettings {
        &self.settings
    }

    /// Records the depth passes for a frame.
    pub fn record(
        &mut self,
        gpu: &Gpu,
        encoder: &mut wgpu::CommandEncoder,
        stage: &Stage,
        camera: &Camera,
        light: &DirectionalLight,
        time: f32,
    ) -> Result<(), String> {
        let casters = stage.casters();
        let cameras = [camera.view];
        let start = Instant::now();
        let frame = self
            .shadow_scene
            .frame(&ShadowFrameDescriptor {
                origin: DVec3::ZERO,
                coverage: match self.settings.covers {
                    Covers::Camera => Coverage::Cameras(&cameras),
                    Covers::Scene => Coverage::Bounds(stage.bounds()),
                },
                casters: Casters::List(&casters),
                receivers: stage.receivers(),
            })
            .map_err(|error| error.to_string())?;
        self.sun
            .record(encoder, &frame, light)
            .map_err(|error| error.to_string())?;
        if let Some(lamps) = &mut self.lamps {
            lamps
                .record(gpu, encoder, &frame, camera.eye, time)
                .map_err(|error| error.to_string())?;
        }
        self.record_time = start.elapsed();
        Ok(())
    }

    /// Draws the scene in a pass with a target of the format of `stroke`.
    pub fn draw(
        &self,
        gpu: &Gpu,
        pass: &mut wgpu::RenderPass<'_>,
        stage: &Stage,
        camera: &Camera,
        lighting: &Lighting,
        stroke: Stroke,
    ) {
        let phong = match stroke {
            Stroke::Picture => &self.picture,
            Stroke::Grey => &self.grey,
            Stroke::Visibility => &self.visibility,
        };
        let shadows = self.bindings.bind_group();
        phong.draw_in_pass(gpu, pass, camera, lighting, shadows, stage.batches());
    }

    pub fn sun_maps(&self) -> &ShadowMaps {
        self.sun.maps()
    }

    /// Returns all maps with the names of their lights.
    pub fn maps(&self) -> Vec<(&'static str, &ShadowMaps)> {
        let mut maps = vec![("sun", self.sun.maps())];
        if let Some(lamps) = &self.lamps {
            let [spots, lamps] = lamps.maps();
            maps.extend([("spots", spots), ("lamps", lamps)]);
        }
        maps
    }
}

/// Returns the fragment stages for a scene.
fn fragment_wgsl(scene: &Scene) -> String {
    let [red, green, blue] = scene.light.sky.to_array();
    let density = scene.light.haze.recip();
    let constants = format!(
        "const HAZE: vec3<f32> = vec3<f32>({red:?}, {green:?}, {blue:?});\n\
         const HAZE_DENSITY: f32 = {density:?};\n"
    );
    let stages = [&constants, include_str!("sun.wgsl")].concat();
    if scene.has_lamps {
        [&stages, hall::FRAGMENT_WGSL, include_str!("lit_hall.wgsl")].concat()
    } else {
        [&stages, include_str!("lit_sun.wgsl")].concat()
    }
}
