//! Compares the visibility in an image with rays that are cast in double precision.

use std::fmt;

use glam::{DVec3, DVec4, Mat4};
use image::RgbaImage;
use shadow_support::scene::Light;
use shadow_support::triangle::Triangle;
use shadow_support::truth::{LightInWorld, World};

use crate::camera::Camera;

/// Is how far an image is from the truth, over the pixels whose surface faces the light.
#[derive(Clone, Copy, Debug)]
pub struct ImageError {
    /// Is the root of the mean squared error of visibility.
    pub rmse: f64,
    /// Are percentages of pixels: dark where they should be lit, and lit where they should be dark.
    pub false_shadow: f64,
    pub false_light: f64,
}

impl ImageError {
    /// Measures the image of a perspective camera. `visibility` returns what a pixel shows; `None`
    /// for one that tells nothing.
    pub fn measure(
        world: &World,
        eye: DVec3,
        clip_from_render: Mat4,
        [width, height]: [u32; 2],
        visibility: impl Fn(u32, u32) -> Option<f64>,
    ) -> Self {
        let render_from_clip = clip_from_render.as_dmat4().inverse();
        let (mut count, mut squares, mut dark, mut lit) = (0.0, 0.0, 0.0, 0.0);
        for (x, y) in (0..height).flat_map(|y| (0..width).map(move |x| (x, y))) {
            let Some(seen) = visibility(x, y) else {
                continue;
            };
            let across = (f64::from(x) + 0.5) / f64::from(width) * 2.0 - 1.0;
            let up = 1.0 - (f64::from(y) + 0.5) / f64::from(height) * 2.0;
            let far = render_from_clip * DVec4::new(across, up, 0.5, 1.0);
            let way = (far.truncate() / far.w - eye).normalize();
            let Some(hit) = world.first_hit(eye, way, 1e4) else {
                continue;
            };
            let position = eye + way * hit.distance;
            let (toward_light, _) = world.light().toward_light_from(position);
            if hit.normal.dot(toward_light) <= 0.0 || !world.light().reaches(position) {
                continue;
            }
            let truth = f64::from(u8::from(!world.is_hidden(position, hit.normal)));
            count += 1.0;
            squares += (seen - truth).powi(2);
            dark += f64::from(u8::from(truth == 1.0 && seen < 0.5));
            lit += f64::from(u8::from(truth == 0.0 && seen > 0.5));
        }
        Self {
            rmse: f64::sqrt(squares / count),
            false_shadow: 100.0 * dark / count,
            false_light: 100.0 * lit / count,
        }
    }
}

/// Prints the errors of an image whose components hold the visibility of the named lights, in this
/// order. `reach` is the distance from the origin within which all triangles are.
pub fn print_errors(
    lights: &[(&str, Light)],
    (triangles, reach): (&[Triangle], f64),
    camera: &Camera,
    visibility: &RgbaImage,
) {
    for (channel, (name, light)) in lights.iter().enumerate() {
        let light = LightInWorld::new(light, DVec3::ZERO);
        let error = ImageError::measure(
            &World::from_triangles(triangles, reach, light),
            camera.eye.as_dvec3(),
            camera.clip_from_render(),
            visibility.dimensions().into(),
            |x, y| Some(f64::from(visibility.get_pixel(x, y).0[channel]) / 255.0),
        );
        println!("{name}: {error}");
    }
}

impl fmt::Display for ImageError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self {
            rmse,
            false_shadow,
            false_light,
        } = self;
        write!(
            f,
            "rmse {rmse:.4}, false shadow {false_shadow:.3} %, false light {false_light:.3} %"
        )
    }
}
