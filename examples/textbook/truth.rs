//! Measures how far an image is from what is truly lit.

use std::collections::BTreeSet;
use std::fmt;

use example_support::camera::Camera;
use glam::{DMat4, DVec3, Mat4};
use wgpu_shadows::ShadowView;

use crate::rays::{Ray, World};
use crate::scene::Scene;

/// Holds what is truly lit at the centre of each pixel.
pub struct Truth {
    /// Is stored row by row; `None` where there is no surface, or one that faces away from the
    /// light.
    lit: Vec<Option<bool>>,
}

/// Holds how a visibility differs from the truth.
pub struct Difference {
    /// Is the fraction of the lit surface that is drawn in shadow.
    false_shadow: f64,
    /// Is the fraction of the shadowed surface that is drawn lit.
    false_light: f64,
    /// Is the root of the mean squared error of the visibility.
    rms: f64,
    /// Is the number of different values that the visibility takes.
    levels: usize,
}

impl Truth {
    /// Casts a ray through each pixel, and from there to the light.
    pub fn new(scene: &Scene, camera: &Camera, size: [u32; 2]) -> Self {
        let world = World::new(scene);
        let eye = camera.eye.as_dvec3();
        let toward_light = scene.toward_light.as_dvec3();
        let render_from_clip = inverse(camera.clip_from_render());
        let lit = centers_ndc(size)
            .map(|center| {
                let ray = Ray {
                    origin: eye,
                    direction: render_from_clip.project_point3(center.with_z(0.5)) - eye,
                };
                let hit = world.first_hit(ray)?;
                let onward = Ray {
                    origin: ray.origin + ray.direction * hit.t,
                    direction: toward_light,
                };
                let faces_light = hit.normal.dot(toward_light) > 0.0;
                faces_light.then(|| !world.is_blocked(onward, hit.cube))
            })
            .collect();
        Self { lit }
    }

    /// Compares `visibility` (row by row); pixels count as lit from one half.
    pub fn compare(&self, visibility: &[f32]) -> Difference {
        let (mut lit, mut shadowed) = (0, 0);
        let (mut false_shadow, mut false_light) = (0, 0);
        let mut squares = 0.0;
        let mut levels = BTreeSet::new();
        for (truth, &drawn) in self.lit.iter().zip(visibility) {
            match truth {
                None => continue,
                Some(true) => {
                    lit += 1;
                    false_shadow += u32::from(drawn < 0.5);
                }
                Some(false) => {
                    shadowed += 1;
                    false_light += u32::from(drawn >= 0.5);
                }
            }
            let truth = f64::from(u8::from(*truth == Some(true)));
            levels.insert(drawn.to_bits());
            squares += (f64::from(drawn) - truth).powi(2);
        }
        Difference {
            false_shadow: f64::from(false_shadow) / f64::from(lit),
            false_light: f64::from(false_light) / f64::from(shadowed),
            rms: (squares / f64::from(lit + shadowed)).sqrt(),
            levels: levels.len(),
        }
    }
}

/// Returns the fraction of the texels of `view` whose grey level is more than one level off the
/// depth that a ray from the light finds. `pixels` is the map as an image of one pixel per texel:
/// four bytes each, all grey.
pub fn compare_map(scene: &Scene, view: &ShadowView, pixels: &[u8]) -> f64 {
    let world = World::new(scene);
    let render_from_clip = inverse(view.clip_from_render());
    let size = view.map_size();
    let wrong = centers_ndc([size, size])
        .zip(pixels.chunks_exact(4))
        .filter(|(center, pixel)| {
            // Depth is reversed: 1 at the light's near plane, 0 at the far plane.
            let near = render_from_clip.project_point3(center.with_z(1.0));
            let far = render_from_clip.project_point3(center.with_z(0.0));
            let ray = Ray {
                origin: near,
                direction: far - near,
            };
            let grey = world.first_hit(ray).map_or(1.0, |hit| hit.t.min(1.0));
            (255.0 * grey - f64::from(pixel[0])).abs() > 1.0
        })
        .count();
    wrong as f64 / f64::from(size * size)
}

impl fmt::Display for Difference {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            formatter,
            "{:5.2} % of the lit is dark, {:5.2} % of the dark is lit, rms error {:.3}, {} levels",
            100.0 * self.false_shadow,
            100.0 * self.false_light,
            self.rms,
            self.levels
        )
    }
}

/// Returns the centres of the pixels of an image, row by row from the top, at depth 0.
fn centers_ndc([width, height]: [u32; 2]) -> impl Iterator<Item = DVec3> {
    (0..width * height).map(move |index| {
        let x = (f64::from(index % width) + 0.5) / f64::from(width);
        let y = (f64::from(index / width) + 0.5) / f64::from(height);
        DVec3::new(2.0 * x - 1.0, 1.0 - 2.0 * y, 0.0)
    })
}

fn inverse(clip_from_render: Mat4) -> DMat4 {
    clip_from_render.as_dmat4().inverse()
}
