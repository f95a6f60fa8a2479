//! Makes a frame: panels, shadows, picture, and the paint of all of it.

use std::time::Duration;

use egui::{FullOutput, PlatformOutput, RawInput, ViewportId};
use egui_wgpu::ScreenDescriptor;
use shadow_support::gpu::Gpu;

use crate::engine::Engine;
use crate::scene::{self, Scene};
use crate::settings::Settings;
use crate::state::{Request, State};
use crate::{address, ui};

/// Holds everything but the window.
pub struct Viewer {
    pub context: egui::Context,
    pub state: State,
    engine: Engine,
    #[cfg(not(target_arch = "wasm32"))]
    format: wgpu::TextureFormat,
    /// Is the time of egui at the last frame, in seconds.
    last_time: f64,
    #[cfg(not(target_arch = "wasm32"))]
    screenshots: u32,
}

/// Is what a host needs after a frame.
pub struct FrameResult {
    pub output: PlatformOutput,
    /// Is the time after which the next frame is wanted.
    pub repaint_after: Duration,
}

impl Viewer {
    /// Makes the viewer for targets of `format`. `address` holds settings as [`address::write`]
    /// writes them; what cannot be read of it is told in the window.
    pub fn new(gpu: Gpu, format: wgpu::TextureFormat, address: &str) -> Result<Self, String> {
        let wanted = address::scene_name(address).unwrap_or(scene::NAMES[0]);
        let found = scene::built_in(wanted);
        let is_unknown = found.is_none();
        let scene = found.or_else(|| scene::built_in(scene::NAMES[0]));
        let scene = scene.ok_or("there is no built-in scene")?;
        let mut settings = scene.settings();
        if gpu.is_software() {
            // A picture of fewer pixels keeps a software rasteriser responsive.
            settings.picture_scale = 0.75;
        }
        let told = address::read(address, &mut settings);
        let mut state = State::new(settings);
        for message in told {
            state.tell(message);
        }
        if is_unknown {
            state.tell(format!("There is no built-in scene {wanted}."));
        }
        let context = egui::Context::default();
        context.set_theme(egui::Theme::Dark);
        Ok(Self {
            context,
            state,
            engine: Engine::new(gpu, format, scene)?,
            #[cfg(not(target_arch = "wasm32"))]
            format,
            last_time: 0.0,
            #[cfg(not(target_arch = "wasm32"))]
            screenshots: 0,
        })
    }

    /// Makes a frame, and paints it into `target` of `size` pixels.
    pub fn frame(
        &mut self,
        input: RawInput,
        target: &wgpu::TextureView,
        size: [u32; 2],
    ) -> FrameResult {
        self.take_dropped_files(&input);
        let time = input.time.unwrap_or(self.last_time);
        let seconds = (time - self.last_time) as f32;
        self.last_time = time;
        self.state.pass_time(seconds.clamp(0.0, 0.25));
        self.state.adapt(seconds);

        let context = self.context.clone();
        let output = context.run_ui(input, |ui| {
            ui::show(ui, &mut self.state, &mut self.engine);
        });
        let wants_screenshot = self.handle_requests();
        self.engine.draw(&mut self.state);
        let wants_more = self.engine.work(&mut self.state);
        let repaint_after = if wants_more || self.state.is_in_motion || wants_screenshot {
            Duration::ZERO
        } else {
            output
                .viewport_output
                .get(&ViewportId::ROOT)
                .map_or(Duration::MAX, |viewport| viewport.repaint_delay)
        };
        let FullOutput {
            platform_output,
            mut textures_delta,
            shapes,
            pixels_per_point,
            ..
        } = output;
        let jobs = context.tessellate(shapes, pixels_per_point);
        let screen = ScreenDescriptor {
            size_in_pixels: size,
            pixels_per_point,
        };
        let (gpu, renderer) = self.engine.renderer();
        for (id, deltas) in &textures_delta.set {
            for delta in deltas {
                renderer.update_texture(&gpu.device, &gpu.queue, *id, delta);
            }
        }
        paint(gpu, renderer, &jobs, &screen, target);
        #[cfg(not(target_arch = "wasm32"))]
        if wants_screenshot {
            self.save_screenshot(&jobs, &screen);
        }
        #[cfg(target_arch = "wasm32")]
        if wants_screenshot {
            self.state
                .tell("A page writes no files: use the browser's own picture.");
        }
        let (_, renderer) = self.engine.renderer();
        for id in &textures_delta.free {
            renderer.free_texture(id);
        }
        textures_delta.clear();
        FrameResult {
            output: platform_output,
            repaint_after,
        }
    }

    /// Shows the scene that `load` returns, or tells why it cannot.
    pub fn open(&mut self, load: Result<Scene, String>) {
        let shown = load.and_then(|scene| {
            let settings = Settings {
                show: self.state.settings.show,
                is_split: self.state.settings.is_split,
                divider: self.state.settings.divider,
                picture_scale: self.state.settings.picture_scale,
                ..scene.settings()
            };
            self.engine.set_scene(scene)?;
            Ok(settings)
        });
        match shown {
            Ok(settings) => {
                self.state.settings = settings;
                self.state.time = 0.0;
                self.state.is_moving = false;
                self.state.day_passes = false;
            }
            Err(error) => self.state.tell(error),
        }
    }

    pub fn gpu(&self) -> &Gpu {
        self.engine.gpu()
    }

    /// Returns whether rays are being cast, or their result is on its way.
    #[cfg(not(target_arch = "wasm32"))]
    pub fn is_casting(&self) -> bool {
        self.engine.truth_progress().is_some() && self.engine.errors(0).is_none()
    }

    fn take_dropped_files(&mut self, input: &RawInput) {
        #[cfg(not(target_arch = "wasm32"))]
        for file in &input.dropped_files {
            let path = file.path().to_path_buf();
            self.state.requests.push(Request::Path(path));
        }
        #[cfg(target_arch = "wasm32")]
        let _ = input;
    }

    /// Does what the panels asked for, and returns whether that was a picture of the window.
    fn handle_requests(&mut self) -> bool {
        let mut wants_screenshot = false;
        for request in std::mem::take(&mut self.state.requests) {
            match request {
                Request::Scene(name) => {
                    let scene = scene::built_in(&name);
                    self.open(scene.ok_or_else(|| format!("There is no scene {name}.")));
                }
                Request::Truth => self.engine.begin_truth(&mut self.state),
                Request::StopTruth => self.engine.stop_truth(),
                Request::Screenshot => wants_screenshot = true,
                #[cfg(target_arch = "wasm32")]
                Request::File { name, bytes } => self.open(scene::from_bytes(&bytes, &name)),
                #[cfg(not(target_arch = "wasm32"))]
                Request::Path(path) => self.open(scene::from_path(&path)),
            }
        }
        wants_screenshot
    }

    /// Paints once more into a texture, and saves it in the working folder.
    #[cfg(not(target_arch = "wasm32"))]
    fn save_screenshot(&mut self, jobs: &[egui::ClippedPrimitive], screen: &ScreenDescriptor) {
        let (gpu, renderer) = self.engine.renderer();
        let texture = gpu.target(self.format, screen.size_in_pixels, 1);
        let view = texture.create_view(&Default::default());
        paint(gpu, renderer, jobs, screen, &view);
        self.screenshots += 1;
        let path = format!("viewer-{}.png", self.screenshots);
        let saved = save_texture(gpu, &texture, path.as_ref());
        self.state.tell(match saved {
            Ok(()) => format!("Saved {path}."),
            Err(error) => error,
        });
    }
}

/// Saves a texture of four bytes a pixel as PNG.
#[cfg(not(target_arch = "wasm32"))]
pub fn save_texture(
    gpu: &Gpu,
    texture: &wgpu::Texture,
    path: &std::path::Path,
) -> Result<(), String> {
    let mut pixels = shadow_support::readback::texels(gpu, gpu.encoder(), texture)?;
    let format = texture.format().remove_srgb_suffix();
    for pixel in pixels.chunks_exact_mut(4) {
        if format == wgpu::TextureFormat::Bgra8Unorm {
            pixel.swap(0, 2);
        }
        pixel[3] = 255;
    }
    example_support::picture::save(path, &pixels, [texture.width(), texture.height()])
}

fn paint(
    gpu: &Gpu,
    renderer: &mut egui_wgpu::Renderer,
    jobs: &[egui::ClippedPrimitive],
    screen: &ScreenDescriptor,
    target: &wgpu::TextureView,
) {
    let mut encoder = gpu.encoder();
    let mut commands = renderer.update_buffers(&gpu.device, &gpu.queue, &mut encoder, jobs, screen);
    let pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        label: Some("panels"),
        color_attachments: &[Some(wgpu::RenderPassColorAttachment {
            view: target,
            depth_slice: None,
            resolve_target: None,
            ops: wgpu::Operations {
                load: wgpu::LoadOp::Clear(wgpu::Color::BLACK),
                store: wgpu::StoreOp::Store,
            },
        })],
        ..Default::default()
    });
    renderer.render(&mut pass.forget_lifetime(), jobs, screen);
    commands.push(encoder.finish());
    gpu.queue.submit(commands);
}
