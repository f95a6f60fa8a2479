//! Owns the device, the scene on it and the shadows of both sides, and draws the picture.

use egui::TextureId;
use example_support::camera::Camera;
use example_support::hall::lights::{LAMPS, SPOTS};
use example_support::phong::Lighting;
use glam::Vec3;
use shadow_support::gpu::Gpu;
use shadow_support::measure::error::Errors;
use wgpu_shadows::DirectionalLight;
use wgpu_shadows::report::ShadowReport;

use crate::device_clock::DeviceClock;
use crate::picture::{Contents, Picture};
use crate::scene::Scene;
use crate::settings::{Covers, Settings, Show, SideSettings};
use crate::side::Side;
use crate::stage::Stage;
use crate::state::State;
use crate::trial::Trial;
use crate::ui::{filter_name, left_share};

/// Holds everything that draws.
pub struct Engine {
    gpu: Gpu,
    scene: Scene,
    stage: Stage,
    sides: [Option<Side>; 2],
    /// Holds the settings that failed, which are not tried again.
    failed: [Option<(SideSettings, u32)>; 2],
    picture: Option<(Picture, TextureId)>,
    renderer: egui_wgpu::Renderer,
    clock: DeviceClock,
    trial: Trial,
    /// Is what the picture shows.
    drawn: Option<Drawn>,
}

/// Is everything that the picture depends on.
#[derive(Clone, PartialEq)]
struct Drawn {
    settings: Settings,
    edited_side: usize,
    time: f32,
    size: [u32; 2],
}

/// Is what the shadows of one side cost in a frame.
pub struct Cost {
    pub passes: u32,
    pub draws: u32,
    pub triangles: u64,
    pub texels: u64,
    pub bytes: u64,
    pub record_ms: f64,
    pub device_ms: Option<f64>,
}

impl Engine {
    /// Makes the engine for windows whose surfaces have `format`.
    pub fn new(gpu: Gpu, format: wgpu::TextureFormat, scene: Scene) -> Result<Self, String> {
        let stage = Stage::new(&gpu.device, &scene).map_err(|error| error.to_string())?;
        let options = egui_wgpu::RendererOptions::default();
        Ok(Self {
            renderer: egui_wgpu::Renderer::new(&gpu.device, format, options),
            clock: DeviceClock::new(&gpu),
            scene,
            stage,
            sides: [None, None],
            failed: [None, None],
            picture: None,
            trial: Trial::default(),
            drawn: None,
            gpu,
        })
    }

    /// Shows another scene.
    pub fn set_scene(&mut self, scene: Scene) -> Result<(), String> {
        let stage = Stage::new(&self.gpu.device, &scene);
        self.stage = stage.map_err(|error| error.to_string())?;
        self.scene = scene;
        self.sides = [None, None];
        self.failed = [None, None];
        self.trial = Trial::default();
        self.drawn = None;
        Ok(())
    }

    pub fn gpu(&self) -> &Gpu {
        &self.gpu
    }

    pub fn scene(&self) -> &Scene {
        &self.scene
    }

    pub fn renderer(&mut self) -> (&Gpu, &mut egui_wgpu::Renderer) {
        (&self.gpu, &mut self.renderer)
    }

    /// Returns the largest side of a picture that the device can draw.
    pub fn largest_picture(&self) -> u32 {
        self.gpu.device.limits().max_texture_dimension_2d.min(4096)
    }

    /// Returns the picture as egui knows it, after it has been made for `size` pixels.
    pub fn picture(&mut self, size: [u32; 2]) -> Result<TextureId, String> {
        if let Some((picture, id)) = &self.picture
            && picture.size == size
        {
            return Ok(*id);
        }
        let picture = Picture::new(&self.gpu, size)?;
        let view = picture.color.create_view(&Default::default());
        let (device, linear) = (&self.gpu.device, wgpu::FilterMode::Linear);
        let id = match &self.picture {
            Some((_, id)) => {
                let renderer = &mut self.renderer;
                renderer.update_egui_texture_from_wgpu_texture(device, &view, linear, *id);
                *id
            }
            None => self.renderer.register_native_texture(device, &view, linear),
        };
        self.picture = Some((picture, id));
        Ok(id)
    }

    /// Returns the size of the picture in pixels.
    pub fn picture_size(&self) -> [u32; 2] {
        self.picture
            .as_ref()
            .map_or([1, 1], |(picture, _)| picture.size)
    }

    /// Records the shadows and draws the picture, if anything differs from what it shows.
    pub fn draw(&mut self, state: &mut State) {
        let wanted = Drawn {
            settings: state.settings.clone(),
            edited_side: state.edited_side,
            time: state.time,
            size: self.picture_size(),
        };
        if self.drawn.as_ref() == Some(&wanted) {
            return;
        }
        self.make_sides(state);
        if self.drawn.as_ref().map(|drawn| drawn.time) != Some(state.time)
            && let Err(error) = self.stage.set_time(&self.gpu.queue, state.time)
        {
            state.tell(error.to_string());
        }
        if let Err(error) = self.draw_picture(state) {
            state.tell(error);
        }
        self.drawn = Some(wanted);
    }

    /// Makes the lights of each side whose settings need other ones.
    fn make_sides(&mut self, state: &mut State) {
        let radians = state.settings.sun_radians();
        for index in 0..2 {
            let settings = &state.settings.sides[index];
            let attempt = (*settings, radians.to_bits());
            let is_made = self.sides[index]
                .as_ref()
                .is_some_and(|side| side.is_made_for(settings, radians));
            if is_made {
                if let Some(side) = &mut self.sides[index] {
                    side.set_frame_settings(settings);
                }
                continue;
            }
            if self.failed[index] == Some(attempt) {
                continue;
            }
            match Side::new(&self.gpu, &self.scene, settings, radians) {
                Ok(side) => {
                    self.sides[index] = Some(side);
                    self.failed[index] = None;
                }
                Err(error) => {
                    self.failed[index] = Some(attempt);
                    state.tell(format!("The shadows keep their last settings: {error}."));
                }
            }
        }
    }

    fn draw_picture(&mut self, state: &State) -> Result<(), String> {
        let Self {
            gpu,
            scene,
            stage,
            sides: [Some(left), Some(right)],
            picture: Some((picture, _)),
            clock,
            ..
        } = self
        else {
            return Ok(());
        };
        let settings = &state.settings;
        let cameras = cameras(settings, picture.size);
        let light = DirectionalLight::new(-settings.toward_sun());
        let lighting = lighting(scene, settings);
        let mut encoder = gpu.encoder();
        for (index, side) in [&mut *left, &mut *right].into_iter().enumerate() {
            clock.begin(&mut encoder, index);
            side.record(
                gpu,
                &mut encoder,
                stage,
                &cameras[index],
                &light,
                state.time,
            )
            .map_err(|error| format!("The shadows cannot be drawn: {error}."))?;
            clock.end(&mut encoder, index);
        }
        let copied = clock.resolve(gpu, &mut encoder);
        let contents = Contents {
            stage,
            sides: [(left, &cameras[0]), (right, &cameras[1])],
            lighting: &lighting,
            show: settings.show,
            left_columns: (left_share(state) * picture.size[0] as f32).round() as u32,
        };
        picture.draw(gpu, &mut encoder, &contents)?;
        gpu.queue.submit([encoder.finish()]);
        clock.read(copied);
        Ok(())
    }

    /// Lets what goes on beside the frames go on: rays, and results that come back. Returns whether
    /// it wants to be called again soon.
    pub fn work(&mut self, state: &mut State) -> bool {
        self.clock.poll(&self.gpu);
        let Some(size) = self.picture.as_ref().map(|(picture, _)| picture.size) else {
            return false;
        };
        let Some(drawn) = &self.drawn else {
            return true;
        };
        let settings = &drawn.settings;
        let size = self.trial.subject_size().unwrap_or(size);
        let cameras = cameras(settings, size);
        let sides = [0, 1].map(|index| self.sides[index].as_ref().zip(Some(&cameras[index])));
        let lighting = lighting(&self.scene, settings);
        let result = self.trial.work(
            &self.gpu,
            settings,
            drawn.time,
            sides,
            &self.stage,
            &lighting,
        );
        match result {
            Ok(wants_more) => wants_more || self.clock.is_waiting(),
            Err(error) => {
                self.trial = Trial::default();
                state.tell(error);
                false
            }
        }
    }

    /// Begins to cast rays.
    pub fn begin_truth(&mut self, state: &mut State) {
        let size = self.picture_size();
        let begun = self
            .trial
            .begin(&self.scene, &state.settings, state.time, size);
        if let Err(error) = begun {
            state.tell(error);
        }
    }

    pub fn stop_truth(&mut self) {
        self.trial = Trial::default();
    }

    /// Returns the share of the rays that are cast; `None` where nobody asked.
    pub fn truth_progress(&self) -> Option<f32> {
        self.trial.progress()
    }

    /// Returns the errors of a side against the truth.
    pub fn errors(&self, side: usize) -> Option<&Errors> {
        self.trial.errors(side)
    }

    /// Returns the truth, or the difference of a side from it, as a texture.
    pub fn truth_texture(
        &mut self,
        context: &egui::Context,
        show: Show,
        side: usize,
    ) -> Option<TextureId> {
        self.trial.texture(context, show, side)
    }

    /// Returns what the shadows of a side cost in the last frame.
    pub fn cost(&self, index: usize) -> Option<Cost> {
        let side = self.sides[index].as_ref()?;
        let mut cost = Cost {
            passes: 0,
            draws: 0,
            triangles: 0,
            texels: 0,
            bytes: 0,
            record_ms: side.record_time.as_secs_f64() * 1e3,
            device_ms: self.clock.milliseconds(index),
        };
        for (_, maps) in side.maps() {
            let report = maps.report();
            cost.passes += report.passes;
            cost.draws += report.draws();
            cost.triangles += report.triangles();
            cost.texels += maps.report().texels();
            cost.bytes += report.bytes_held;
        }
        Some(cost)
    }

    /// Returns the reports of a side's lights.
    pub fn reports(&self, side: usize) -> Vec<(&'static str, &ShadowReport)> {
        let maps = self.sides[side].iter().flat_map(Side::maps);
        maps.map(|(name, maps)| (name, maps.report())).collect()
    }

    /// Returns the number of layers of a light's maps: of the sun, the spots, the lamps.
    pub fn layers(&self, light: usize) -> u32 {
        let layers = self.sides.iter().flatten().filter_map(|side| {
            let maps = side.maps();
            maps.get(light)
                .map(|(_, maps)| maps.view_uniforms().len() as u32)
        });
        layers.max().unwrap_or(0)
    }

    /// Returns the descriptors of a side as Rust.
    pub fn rust(&self, settings: &Settings, side: usize) -> String {
        let side = &settings.sides[side];
        let mut text = side.frame_comments() + &side.sun_rust(settings.sun_radians());
        if self.scene.has_lamps {
            text += &format!("\n\n// The spots:\n{}", side.spots_rust(SPOTS as u32));
            text += &format!("\n\n// The lamps:\n{}", side.lamps_rust(LAMPS as u32));
        }
        text
    }

    /// Returns a few words on the settings of a side.
    pub fn title(&self, settings: &Settings, side: usize) -> String {
        let own = &settings.sides[side];
        let is_textbook = *own == self.scene.sides[0];
        let filter = filter_name(own.filter);
        let maps = match own.cascades {
            1 => format!("{}²", own.map_size),
            _ if own.divides_map => format!("{}², divided", own.map_size),
            count => format!("{count} × {}²", own.map_size),
        };
        let covers = if own.covers == Covers::Scene {
            ", whole scene"
        } else {
            ""
        };
        let name = if is_textbook { "Textbook: " } else { "" };
        format!("{name}{filter}, {maps}{covers}")
    }
}

/// Returns the cameras of both sides, which differ in the distance where shadows end.
fn cameras(settings: &Settings, size: [u32; 2]) -> [Camera; 2] {
    [0, 1].map(|side| {
        let end = settings.sides[side].max_distance;
        settings.viewpoint.camera(size, end)
    })
}

/// Returns the colours of the light at the height of the sun.
fn lighting(scene: &Scene, settings: &Settings) -> Lighting {
    let toward_sun = settings.toward_sun();
    let height = (toward_sun.y * 3.0).clamp(0.0, 1.0);
    // A low sun is red, and one below the horizon gives no light.
    let tint = Vec3::new(1.0, 0.45 + 0.55 * height, 0.2 + 0.8 * height);
    let strength = (toward_sun.y * 12.0 + 0.6).clamp(0.0, 1.0);
    Lighting {
        light: toward_sun.extend(0.0),
        light_color: scene.light.sun * tint * strength,
        light_range: f32::INFINITY,
        ambient: scene.light.ambient,
        sky: scene.light.sky,
    }
}
