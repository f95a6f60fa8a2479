//! Measures the shadows of a running scene through its own casters, and marks the places that are
//! worst.
//!
//! `cargo run --example error_meter [FOLDER]` measures a sun over boxes for 60 frames of
//! 64 places each: as it is, with a bias that is too large, and with a caster missing from its
//! frame. It prints each estimate with its interval beside the error of the whole image by rays in
//! double precision, and what the measurement cost. The images are in `target/error_meter`, or the
//! folder named: red circles mark false shadow, and blue ones false light.

use std::error::Error;
use std::path::Path;
use std::process::ExitCode;

use example_support::picture;
use glam::DVec3;
use shadow_support::camera::pixel_rays;
use shadow_support::gpu::{Gpu, GpuRequest};
use shadow_support::library::SceneCasters;
use shadow_support::probe::{Point, PointShader};
use shadow_support::random::Random;
use shadow_support::scene::{Light, Scene};
use shadow_support::scenes;
use shadow_support::truth::World;
use wgpu_shadows::meter::{
    ErrorMeter, ErrorMeterDescriptor, MeasuredError, MeasuredLight, MeterReport, Receiver,
};
use wgpu_shadows::{
    Bias, Casters, Coverage, DirectionalLight, DirectionalShadow, DirectionalShadowDescriptor,
    ShadowBindings, ShadowBindingsDescriptor, ShadowCaster, ShadowFrameDescriptor, ShadowScene,
    report::ShadowReport,
};

/// Is the width and height of the images.
const SIZE: [u32; 2] = [960, 540];

/// Is the number of frames that are measured, and of places in each.
const FRAMES: u32 = 60;
const PLACES: usize = 64;

/// Is the radius of the circles in pixels.
const RADIUS: f64 = 9.0;

fn main() -> ExitCode {
    match run() {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error_meter: {error}");
            ExitCode::FAILURE
        }
    }
}

fn run() -> Result<(), Box<dyn Error>> {
    let folder = picture::folder_from_arguments("target/error_meter")?;
    let gpu = Gpu::new(&GpuRequest::default())?;
    let scene = scenes::boxes("boxes", DVec3::ZERO);
    let stage = Stage::new(&gpu, &scene)?;
    let casters = SceneCasters::new(&gpu, &scene);
    let list = casters.list();
    let kept = (0..).zip(&list).filter(|(index, _)| index % 6 != 1);
    let incomplete: Vec<_> = kept.map(|(_, caster)| *caster).collect();
    let wrong_bias = Bias::Manual {
        constant: 0.4,
        slope: 0.0,
    };
    for (name, bias, drawn) in [
        ("as_it_is", Bias::Auto, &list),
        ("wrong_bias", wrong_bias, &list),
        ("missing_casters", Bias::Auto, &incomplete),
    ] {
        let seen = stage.measure(bias, drawn, &list)?;
        seen.print(name);
        stage.save(&folder.join(format!("{name}.png")), &seen)?;
    }
    println!("pictures in {}", folder.display());
    Ok(())
}

/// Is a surface that the camera sees.
struct Seen {
    pixel: u32,
    receiver: Receiver,
    /// Is false where nothing lies between it and the light.
    is_hidden: bool,
}

struct Stage<'a> {
    gpu: &'a Gpu,
    scene: &'a Scene,
    light: DirectionalLight,
    seen: Vec<Seen>,
}

/// Is what a run measured.
struct Outcome {
    measured: MeasuredError,
    /// Holds the visibility of each surface that is seen.
    visibilities: Vec<f32>,
    rmse_by_rays: f64,
    meter: MeterReport,
    shadow: ShadowReport,
}

impl<'a> Stage<'a> {
    /// Finds what the camera sees that faces the light, with the truth by rays.
    fn new(gpu: &'a Gpu, scene: &'a Scene) -> Result<Self, Box<dyn Error>> {
        let Light::Sun { direction, .. } = scene.light else {
            return Err("the scene must have a sun".into());
        };
        let world = World::new(scene);
        let rays = (0..).zip(pixel_rays(&scene.camera, SIZE));
        let seen = rays.filter_map(|(pixel, ray)| {
            let hit = world.first_hit(ray.start, ray.direction, ray.reach)?;
            let position = ray.start + ray.direction * hit.distance;
            let faces = hit.normal.dot(direction.as_dvec3()) < 0.0;
            faces.then(|| Seen {
                pixel,
                receiver: Receiver {
                    position_render: position.as_vec3(),
                    normal: hit.normal.as_vec3(),
                },
                is_hidden: world.is_hidden(position, hit.normal),
            })
        });
        Ok(Self {
            gpu,
            scene,
            light: DirectionalLight::new(direction),
            seen: seen.collect(),
        })
    }

    /// Measures a sun whose frames have the casters `drawn`, where the scene has `all`.
    fn measure(
        &self,
        bias: Bias,
        drawn: &[&dyn ShadowCaster],
        all: &[&dyn ShadowCaster],
    ) -> Result<Outcome, Box<dyn Error>> {
        let device = &self.gpu.device;
        let descriptor = DirectionalShadowDescriptor {
            bias,
            ..Default::default()
        };
        let mut sun = DirectionalShadow::new(device, &descriptor)?;
        let mut meter = ErrorMeter::new(&ErrorMeterDescriptor::new(sun.maps()))?;
        let (mut scene, mut whole_scene) = (ShadowScene::new(), ShadowScene::new());
        let mut random = Random::new(1);
        for _ in 0..FRAMES {
            let frame = |casters| ShadowFrameDescriptor {
                origin: self.scene.origin,
                coverage: Coverage::Cameras(std::slice::from_ref(&self.scene.camera)),
                casters: Casters::List(casters),
                receivers: &[],
            };
            let (drawn, all) = (scene.frame(&frame(drawn))?, whole_scene.frame(&frame(all))?);
            let places: Vec<Receiver> = (0..PLACES)
                .map(|_| self.seen[random.index(self.seen.len())].receiver)
                .collect();
            let mut encoder = self.gpu.encoder();
            // The first frame draws the maps, and the others keep them; each counts as if it drew.
            sun.invalidate();
            sun.record(&mut encoder, &drawn, &self.light)?;
            let light = MeasuredLight::Directional(&self.light);
            meter.record(&mut encoder, &all, sun.maps(), &light, &places)?;
            self.gpu.submit(encoder);
        }
        device.poll(wgpu::PollType::wait_indefinitely())?;
        let visibilities = self.visibilities(&sun)?;
        let errors = self
            .seen
            .iter()
            .zip(&visibilities)
            .map(|(seen, visibility)| {
                let error = f64::from(*visibility) - f64::from(u8::from(!seen.is_hidden));
                error * error
            });
        Ok(Outcome {
            rmse_by_rays: (errors.sum::<f64>() / self.seen.len() as f64).sqrt(),
            measured: meter.measured(),
            visibilities,
            meter: *meter.report(),
            shadow: sun.maps().report().clone(),
        })
    }

    /// Returns the visibility of all that is seen.
    fn visibilities(&self, sun: &DirectionalShadow) -> Result<Vec<f32>, Box<dyn Error>> {
        let bindings = ShadowBindings::new(
            &self.gpu.device,
            &ShadowBindingsDescriptor {
                visibility: wgpu::ShaderStages::COMPUTE,
                lights: &[("sun", sun.maps())],
                ..Default::default()
            },
        )?;
        let value = "shadow_sun(point.position, point.normal)";
        let layout = bindings.layout();
        let shader = PointShader::new(self.gpu, bindings.wgsl(), "f32", value, layout);
        let receivers = self.seen.iter().map(|seen| seen.receiver);
        let points: Vec<_> = receivers
            .map(|receiver| Point::new(receiver.position_render, receiver.normal))
            .collect();
        Ok(shader.ask(self.gpu, bindings.bind_group(), &points))
    }

    /// Writes an image with the worst places marked.
    fn save(&self, path: &Path, outcome: &Outcome) -> Result<(), String> {
        let [width, height] = SIZE;
        let grey = |level: f32| [(255.0 * level) as u8; 3];
        let mut pixels = vec![grey(0.25); (width * height) as usize];
        for (seen, visibility) in self.seen.iter().zip(&outcome.visibilities) {
            let cosine = -seen.receiver.normal.dot(self.light.direction.normalize());
            pixels[seen.pixel as usize] = grey(0.3 + 0.6 * visibility * cosine);
        }
        let camera = &self.scene.camera;
        let clip_from_render = camera.clip_from_view * camera.view_from_render;
        for place in &outcome.measured.worst {
            let position = (place.position_world - self.scene.origin).as_vec3();
            let ndc = clip_from_render.project_point3(position);
            let [x, y] = [0.5 + 0.5 * ndc.x, 0.5 - 0.5 * ndc.y].map(f64::from);
            let is_false_shadow = place.visibility < place.visibility_by_rays;
            let color = if is_false_shadow {
                [230, 40, 30]
            } else {
                [40, 90, 255]
            };
            let middle = [x * f64::from(width), y * f64::from(height)];
            circle(&mut pixels, middle, color);
        }
        let rgba: Vec<u8> = pixels
            .iter()
            .flat_map(|[r, g, b]| [*r, *g, *b, 255])
            .collect();
        picture::save(path, &rgba, SIZE)
    }
}

/// Draws a circle around a place of the image.
fn circle(pixels: &mut [[u8; 3]], middle: [f64; 2], color: [u8; 3]) {
    let [width, height] = SIZE.map(f64::from);
    for step in 0..200 {
        let angle = std::f64::consts::TAU * f64::from(step) / 200.0;
        for radius in [RADIUS, RADIUS + 0.7] {
            let x = middle[0] + radius * angle.cos();
            let y = middle[1] + radius * angle.sin();
            if (0.0..width).contains(&x) && (0.0..height).contains(&y) {
                pixels[y as usize * SIZE[0] as usize + x as usize] = color;
            }
        }
    }
}

impl Outcome {
    fn print(&self, name: &str) {
        let MeasuredError {
            rmse,
            false_shadow,
            false_light,
            ..
        } = &self.measured;
        println!(
            "{name}: rmse {:.4} ({:.4} to {:.4}), by rays {:.4}; \
             false shadow {:.2} %, false light {:.2} %",
            rmse.value,
            rmse.low,
            rmse.high,
            self.rmse_by_rays,
            100.0 * false_shadow.value,
            100.0 * false_light.value,
        );
        let (meter, shadow) = (&self.meter, &self.shadow);
        let triangles: u64 = shadow.views.iter().map(|view| view.triangles).sum();
        println!(
            "  a frame: {} places, {} texels, {} draws, {} triangles in {} passes; \
             the light's own: {} texels, {} draws, {} triangles",
            meter.places,
            meter.rays,
            meter.draws,
            meter.triangles,
            meter.passes,
            shadow.texels(),
            shadow.draws(),
            triangles,
        );
    }
}
