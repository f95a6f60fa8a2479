//! Shows a lit and shadowed scene in a panel of egui, beside controls, by a paint callback.
//!
//! `cargo run -p guest-egui [FOLDER]` draws the window into a picture in the folder,
//! `target/guests` by default, without opening it.

mod panel;
mod shadows;

use std::error::Error;

use egui::{Pos2, RawInput, Rect, Sense, vec2};
use egui_wgpu::{Callback, Renderer, RendererOptions, ScreenDescriptor};
use example_support::keeping::{self, Frame};
use example_support::phong::DEPTH_FORMAT;
use example_support::picture;
use shadow_support::gpu::{Gpu, GpuRequest};
use shadow_support::readback;

use crate::panel::{Panel, Scene, State};

const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8Unorm;
const FRAMES: u32 = 60;

fn main() -> Result<(), Box<dyn Error>> {
    let folder = picture::folder_from_arguments("target/guests")?;
    let size = [960, 540];
    let mut window = Window::new(size)?;
    let mut pixels = Vec::new();
    // Panels find their sizes in the first frames.
    for _ in 0..4 {
        pixels = window.frame(0.3, 0.4)?;
    }
    picture::save(&folder.join("egui.png"), &pixels, size)?;

    let mut runs = Vec::new();
    for keeps_nothing in [false, true] {
        let mut window = Window::new([640, 360])?;
        window.keeps_nothing = keeps_nothing;
        let mut frames = Vec::new();
        for frame in 0..2 * FRAMES {
            let step = frame.min(FRAMES - 1) as f32;
            // The cube turns, and in the second half of the moving frames the sun does, too.
            let sun = (step - 0.5 * FRAMES as f32).max(0.0);
            let pixels = window.frame(0.02 * sun, 0.05 * step)?;
            let scene = window.scene();
            let passes = scene.shadows.sun.maps().report().passes;
            frames.push(Frame {
                pixels,
                record_time: scene.record_time,
                passes,
            });
        }
        runs.push(frames);
    }
    keeping::check(&runs[0], &runs[1], FRAMES as usize)?;
    Ok(())
}

/// Is a window that nobody sees.
struct Window {
    gpu: Gpu,
    size: [u32; 2],
    context: egui::Context,
    renderer: Renderer,
    target: wgpu::Texture,
    keeps_nothing: bool,
}

impl Window {
    fn new(size: [u32; 2]) -> Result<Self, Box<dyn Error>> {
        let gpu = Gpu::new(&GpuRequest::default())?;
        let options = RendererOptions {
            depth_stencil_format: Some(DEPTH_FORMAT),
            ..RendererOptions::PREDICTABLE
        };
        let mut renderer = Renderer::new(&gpu.device, FORMAT, options);
        let panels = Gpu::from_device(gpu.adapter.clone(), gpu.device.clone(), gpu.queue.clone());
        renderer
            .callback_resources
            .insert(Scene::new(panels, FORMAT)?);
        Ok(Self {
            target: gpu.target(FORMAT, size, 1),
            context: egui::Context::default(),
            gpu,
            size,
            renderer,
            keeps_nothing: false,
        })
    }

    fn scene(&self) -> &Scene {
        let scene = self.renderer.callback_resources.get();
        scene.expect("the scene that was inserted")
    }

    /// Draws a frame, and returns its pixels.
    fn frame(&mut self, sun_angle: f32, cube_angle: f32) -> Result<Vec<u8>, Box<dyn Error>> {
        let [width, height] = self.size.map(|side| side as f32);
        let input = RawInput {
            screen_rect: Some(Rect::from_min_size(Pos2::ZERO, vec2(width, height))),
            ..Default::default()
        };
        let mut state = State {
            sun_angle,
            cube_angle,
            aspect: 1.0,
            keeps_nothing: self.keeps_nothing,
        };
        let mut output = self.context.run_ui(input, |ui| show(ui, &mut state));
        let jobs = self
            .context
            .tessellate(output.shapes, output.pixels_per_point);
        let screen = ScreenDescriptor {
            size_in_pixels: self.size,
            pixels_per_point: output.pixels_per_point,
        };
        for (id, deltas) in &output.textures_delta.set {
            for delta in deltas {
                self.renderer
                    .update_texture(&self.gpu.device, &self.gpu.queue, *id, delta);
            }
        }
        output.textures_delta.clear();
        self.paint(&jobs, &screen);
        Ok(readback::rgba8(&self.gpu, &self.target).into_raw())
    }

    fn paint(&mut self, jobs: &[egui::ClippedPrimitive], screen: &ScreenDescriptor) {
        let Gpu { device, queue, .. } = &self.gpu;
        let depth = self.gpu.target(DEPTH_FORMAT, self.size, 1);
        let mut encoder = self.gpu.encoder();
        let mut commands = self
            .renderer
            .update_buffers(device, queue, &mut encoder, jobs, screen);
        let pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("egui"),
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: &self.target.create_view(&Default::default()),
                depth_slice: None,
                resolve_target: None,
                ops: wgpu::Operations::default(),
            })],
            depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                view: &depth.create_view(&Default::default()),
                // The panel's depth is reversed: the far end of the world is 0.
                depth_ops: Some(wgpu::Operations {
                    load: wgpu::LoadOp::Clear(0.0),
                    store: wgpu::StoreOp::Discard,
                }),
                stencil_ops: None,
            }),
            ..Default::default()
        });
        self.renderer
            .render(&mut pass.forget_lifetime(), jobs, screen);
        commands.push(encoder.finish());
        queue.submit(commands);
    }
}

fn show(ui: &mut egui::Ui, state: &mut State) {
    egui::Panel::left("controls")
        .exact_size(200.0)
        .show(ui, |ui| {
            ui.heading("Shadows in egui");
            ui.add(egui::Slider::new(&mut state.sun_angle, 0.0..=6.0).text("sun"));
            ui.add(egui::Slider::new(&mut state.cube_angle, 0.0..=6.0).text("cube"));
        });
    egui::CentralPanel::default().show(ui, |ui| {
        let (rect, _) = ui.allocate_exact_size(ui.available_size(), Sense::hover());
        state.aspect = rect.width() / rect.height();
        ui.painter()
            .add(Callback::new_paint_callback(rect, Panel(*state)));
    });
}
