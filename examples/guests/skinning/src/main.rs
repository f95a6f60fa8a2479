//! Draws characters that a skin and a morph target move in the vertex stage, and their shadows,
//! which that same stage casts.
//!
//! `cargo run -p guest-skinning [FOLDER]` writes the image above the visibility of the two lights
//! (red sun, green lamp) into the folder, `target/guests` by default.

mod character;
mod engine;
mod scene;
mod shadows;

use std::error::Error;
use std::time::{Duration, Instant};

use example_support::image_error;
use example_support::keeping::{self, Frame};
use example_support::picture;
use shadow_support::gpu::{Gpu, GpuRequest};
use shadow_support::readback;
use shadow_support::scene::Light;

use crate::engine::{Actor, Renderer};
use crate::scene::{Lights, Scene, TOWARD_SUN, camera};
use crate::shadows::Shadows;

const FRAMES: u32 = 60;
const SECONDS_PER_FRAME: f32 = 1.0 / 30.0;

fn main() -> Result<(), Box<dyn Error>> {
    let folder = picture::folder_from_arguments("target/guests")?;
    let gpu = Gpu::new(&GpuRequest::default())?;
    let size = [960, 540];
    let mut engine = Engine::new(&gpu, size)?;
    engine.draw_frame(9, false)?;
    let image = readback::rgba8(&gpu, &engine.renderer.image);
    let visibility = readback::rgba8(&gpu, &engine.renderer.visibility);
    let both = [image.as_raw().as_slice(), visibility.as_raw()].concat();
    picture::save(&folder.join("skinning.png"), &both, [size[0], 2 * size[1]])?;
    println!("maps: {} MiB", engine.shadows.totals().1 >> 20);
    measure_errors(&engine, &visibility);

    keeping::compare(FRAMES, || Engine::new(&gpu, [320, 180]))
}

struct Engine<'g> {
    gpu: &'g Gpu,
    size: [u32; 2],
    scene: Scene,
    actors: Vec<Actor>,
    lights: Lights,
    shadows: Shadows,
    renderer: Renderer,
}

impl<'g> Engine<'g> {
    fn new(gpu: &'g Gpu, size: [u32; 2]) -> Result<Self, Box<dyn Error>> {
        let scene = Scene::new(&gpu.device)?;
        let layout = engine::uniform_layout(gpu);
        let shadows = Shadows::new(&gpu.device, &scene, &layout)?;
        let actors = (0..).zip(scene.poses(0.0));
        let actors = actors.map(|actor| Actor::new(gpu, &layout, &scene.character, actor));
        Ok(Self {
            actors: actors.collect(),
            renderer: Renderer::new(gpu, size, &layout, &shadows.bindings),
            lights: Lights::new(),
            gpu,
            size,
            scene,
            shadows,
        })
    }

    /// Draws a frame, and returns how long the library took to record its part.
    fn draw_frame(&mut self, frame: u32, keeps_nothing: bool) -> Result<Duration, Box<dyn Error>> {
        let poses = self.scene.poses(frame as f32 * SECONDS_PER_FRAME);
        for (actor, pose) in self.actors.iter_mut().zip(poses) {
            actor.set_pose(self.gpu, pose);
        }
        if keeps_nothing {
            self.shadows.invalidate();
        }
        let camera = camera(self.size);
        let mut encoder = self.gpu.encoder();
        let begin = Instant::now();
        self.shadows
            .record(&mut encoder, &self.actors, camera.view, &self.lights)?;
        let record_time = begin.elapsed();
        self.renderer.draw(
            self.gpu,
            &mut encoder,
            (&self.scene, &self.actors),
            (&camera, &self.lights),
            &self.shadows,
        );
        self.gpu.submit(encoder);
        Ok(record_time)
    }
}

impl keeping::Engine for Engine<'_> {
    fn draw(&mut self, frame: u32, keeps_nothing: bool) -> Result<Frame, Box<dyn Error>> {
        let record_time = self.draw_frame(frame, keeps_nothing)?;
        Ok(Frame {
            pixels: readback::rgba8(self.gpu, &self.renderer.visibility).into_raw(),
            record_time,
            passes: self.shadows.totals().0,
        })
    }
}

/// Prints the error of the visibility texture against rays, light by light.
fn measure_errors(engine: &Engine<'_>, visibility: &image::RgbaImage) {
    let lamp = engine.lights.lamp;
    let lights = [
        (
            "sun",
            Light::Sun {
                direction: -TOWARD_SUN,
                angular_diameter_radians: 0.0,
            },
        ),
        (
            "lamp",
            Light::Point {
                position_world: lamp.position_world,
                range: lamp.range,
                radius_world: 0.0,
            },
        ),
    ];
    let poses: Vec<_> = engine
        .actors
        .iter()
        .map(|actor| actor.pose.clone())
        .collect();
    let triangles = engine.scene.triangles(&poses);
    let camera = camera(engine.size);
    image_error::print_errors(&lights, (&triangles, 18.0), &camera, visibility);
}
