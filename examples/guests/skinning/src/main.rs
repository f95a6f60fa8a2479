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

use example_support::image_error::ImageError;
use example_support::keeping::{self, Frame};
use example_support::picture;
use shadow_support::gpu::{Gpu, GpuRequest};
use shadow_support::readback;
use shadow_support::scene::Light;
use shadow_support::truth::{LightInWorld, World};

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
    engine.draw(9, false)?;
    let image = readback::rgba8(&gpu, &engine.renderer.image);
    let visibility = readback::rgba8(&gpu, &engine.renderer.visibility);
    let both = [image.as_raw().as_slice(), visibility.as_raw()].concat();
    picture::save(&folder.join("skinning.png"), &both, [size[0], 2 * size[1]])?;
    println!("maps: {} MiB", engine.shadows.totals().1 >> 20);
    measure_errors(&engine, &visibility);

    let mut runs = Vec::new();
    for keeps_nothing in [false, true] {
        let mut engine = Engine::new(&gpu, [320, 180])?;
        let mut frames = Vec::new();
        for frame in 0..2 * FRAMES {
            let record_time = engine.draw(frame.min(FRAMES - 1), keeps_nothing)?;
            let pixels = readback::rgba8(&gpu, &engine.renderer.visibility).into_raw();
            let passes = engine.shadows.totals().0;
            frames.push(Frame {
                pixels,
                record_time,
                passes,
            });
        }
        runs.push(frames);
    }
    keeping::check(&runs[0], &runs[1], FRAMES as usize)?;
    Ok(())
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
    fn draw(&mut self, frame: u32, keeps_nothing: bool) -> Result<Duration, Box<dyn Error>> {
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
    for (channel, (name, light)) in lights.into_iter().enumerate() {
        let light = LightInWorld::new(&light, glam::DVec3::ZERO);
        let camera = camera(engine.size);
        let error = ImageError::measure(
            &World::from_triangles(&triangles, 18.0, light),
            camera.eye.as_dvec3(),
            camera.clip_from_render(),
            engine.size,
            |x, y| Some(f64::from(visibility.get_pixel(x, y).0[channel]) / 255.0),
        );
        println!("{name}: {error}");
    }
}
