//! Shows shadows of `wgpu-shadows` beside those of kiss3d, in kiss3d, and measures both.
//!
//! `cargo run -p guest-kiss3d [FOLDER]` writes the picture into the folder, `target/guests` by
//! default. It opens no window.

mod light;
mod material;
mod measure;
mod object;
mod scene;
mod shadows;
mod truth;

use std::error::Error;

use example_support::image_error::ImageError;
use example_support::keeping::{self, Frame};
use example_support::picture;
use glam::{DVec3, Mat4};
use image::{GenericImage, RgbImage};
use kiss3d::post_processing::Tonemap;
use kiss3d::prelude::*;
use shadow_support::truth::LightInWorld;

use crate::material::ShadowedScene;
use crate::object::vec3;
use crate::scene::Demo;

const FRAMES: u32 = 60;

#[kiss3d::main]
async fn main() {
    let folder = picture::folder_from_arguments("target/guests").expect("a folder");
    let mut guest = Guest::new(960, 540).await;
    guest
        .compare(&folder.join("kiss3d.png"))
        .await
        .expect("a picture");
    guest.measure_errors().await.expect("shadows");
    guest.check_stale().await.expect("no stale shadows");
}

/// Holds a surface without a window, and the scene twice.
struct Guest {
    surface: OffscreenSurface,
    camera: OrbitCamera3d,
    /// Is shaded by kiss3d, with its own shadows.
    own: Demo,
    /// Is shaded by the guest's material.
    ours: Demo,
    shadows: ShadowedScene,
}

impl Guest {
    async fn new(width: u32, height: u32) -> Self {
        let mut surface = OffscreenSurface::new(width, height).await;
        surface.set_background_color(Color::new(0.02, 0.03, 0.05, 1.0));
        surface.set_ambient(0.1);
        // Images then tell radiance.
        surface.set_tonemap(Tonemap::None);
        let (ours, shadows) = shadowed_scene();
        Self {
            surface,
            camera: OrbitCamera3d::new(Vec3::new(-4.0, 5.0, 7.0), Vec3::new(0.4, 0.4, 0.0)),
            own: Demo::new(),
            ours,
            shadows,
        }
    }

    async fn image(&mut self, ours: bool) -> RgbImage {
        let demo = if ours { &mut self.ours } else { &mut self.own };
        // kiss3d's shadows are not drawn where the guest's are.
        self.surface.set_shadows_enabled(!ours);
        self.surface
            .render_image_3d(&mut demo.root, &mut self.camera)
            .await
    }

    /// Writes the picture of both, and prints what they hold and draw.
    async fn compare(&mut self, path: &std::path::Path) -> Result<(), Box<dyn Error>> {
        for demo in [&mut self.own, &mut self.ours] {
            demo.advance(0);
        }
        // A mirror of kiss3d shows kiss3d's shadows of the frame before.
        self.image(false).await;
        let own = self.image(false).await;
        let ours = self.image(true).await;
        let mut both = RgbImage::new(own.width() + ours.width(), own.height());
        both.copy_from(&own, 0, 0)?;
        both.copy_from(&ours, own.width(), 0)?;
        both.save(path)?;

        let window = self.surface.window();
        let layers = u64::from(window.shadow_atlas_layers());
        let texels = u64::from(window.shadow_resolution()).pow(2);
        // Each of its layers has four bytes of depth and four of transmittance a texel.
        let bytes = layers * texels * 8;
        let held = self.shadows.state().shadows.totals().1;
        println!("maps: kiss3d {} MiB, guest {} MiB", bytes >> 20, held >> 20);
        // It draws four cascades, a cone and six faces in every frame.
        println!("passes in {FRAMES} frames: kiss3d {}", FRAMES * 11);
        Ok(())
    }

    /// Prints the error of both against rays, light by light.
    async fn measure_errors(&mut self) -> Result<(), Box<dyn Error>> {
        self.surface.set_ambient(0.0);
        for light in ["sun", "spot", "lamp"] {
            for ours in [false, true] {
                let demo = if ours { &mut self.ours } else { &mut self.own };
                let nodes = [&mut demo.sun, &mut demo.spot, &mut demo.lamp];
                for (name, node) in ["sun", "spot", "lamp"].into_iter().zip(nodes) {
                    node.set_visible(name == light);
                }
                demo.mirror.set_visible(false);
                let with = self.image(ours).await;
                self.set_casting(ours, false);
                let without = self.image(ours).await;
                self.set_casting(ours, true);
                let world = truth::world(&self.shadows.state().shadows, self.light(light));
                let clip_from_world = self.camera.transformation().to_cols_array();
                let error = ImageError::measure(
                    &world,
                    vec3(self.camera.eye()).as_dvec3(),
                    Mat4::from_cols_array(&clip_from_world),
                    [with.width(), with.height()],
                    |x, y| truth::visibility(&with, &without, x, y),
                );
                println!(
                    "{light}, {}: {error}",
                    if ours { "guest" } else { "kiss3d" }
                );
            }
        }
        Ok(())
    }

    /// Draws the same frames with maps that are kept and with maps that are not, and compares.
    async fn check_stale(&mut self) -> Result<(), Box<dyn Error>> {
        self.surface.resize(320, 180);
        let mut runs = Vec::new();
        for keeps_nothing in [false, true] {
            (self.ours, self.shadows) = shadowed_scene();
            self.shadows.state().keeps_nothing = keeps_nothing;
            let mut frames = Vec::new();
            for frame in 0..2 * FRAMES {
                if frame < FRAMES {
                    self.ours.advance(frame);
                }
                let pixels = self.image(true).await.into_raw();
                let state = self.shadows.state();
                frames.push(Frame {
                    pixels,
                    record_time: state.record_time,
                    passes: state.passes,
                });
            }
            runs.push(frames);
        }
        keeping::check(&runs[0], &runs[1], FRAMES as usize)?;
        Ok(())
    }

    fn set_casting(&mut self, ours: bool, casts: bool) {
        let demo = if ours { &mut self.ours } else { &mut self.own };
        demo.root
            .apply_to_objects_mut_recursive(&mut |object| object.set_casts_shadows(casts));
        demo.mirror.set_casts_shadows(false);
    }

    fn light(&self, name: &str) -> LightInWorld {
        let near = |node: &SceneNode3d, range, cone_cosine| LightInWorld::Near {
            position: vec3(node.world_position()).as_dvec3(),
            range,
            radius: 0.0,
            axis: vec3(node.world_pose().rotation * Vec3::NEG_Z).as_dvec3(),
            cone_cosine,
        };
        match name {
            "sun" => LightInWorld::Far {
                toward_light: DVec3::new(0.7, 1.0, 0.4).normalize(),
                disc_tangent: 0.0,
            },
            "spot" => near(&self.ours.spot, 30.0, f64::cos(0.5)),
            _ => near(&self.ours.lamp, 9.0, -2.0),
        }
    }
}

/// Returns the scene with the library's shadows.
fn shadowed_scene() -> (Demo, ShadowedScene) {
    let shadows = ShadowedScene::new().expect("shadows");
    let mut demo = Demo::new();
    // This is all that an application calls.
    shadows.attach(&mut demo.root);
    (demo, shadows)
}
