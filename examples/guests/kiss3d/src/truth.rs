//! Takes visibility from kiss3d's images, and the scene's triangles for rays.

use image::RgbImage;
use shadow_support::triangle::Triangle;
use shadow_support::truth::{LightInWorld, World};

use crate::shadows::Shadows;

/// Casts rays through the triangles of all objects.
pub fn world(shadows: &Shadows, light: LightInWorld) -> World {
    let mut triangles = Vec::new();
    for (_, caster) in shadows.casters.iter() {
        let (vertices, faces) = (caster.0.vertices(), caster.0.faces());
        for copy in caster.0.copies() {
            let corner = |index: u32| {
                copy.as_dmat4()
                    .transform_point3(vertices[index as usize].as_dvec3())
            };
            triangles.extend(faces.iter().map(|face| Triangle(face.map(corner))));
        }
    }
    World::from_triangles(&triangles, 16.0, light)
}

/// Returns the visibility in a pixel, from an image with the shadows of one light and one without;
/// `None` where the image is too dark to tell it to 2 %, or clipped.
pub fn visibility(with: &RgbImage, without: &RgbImage, x: u32, y: u32) -> Option<f64> {
    let full = linear(without.get_pixel(x, y).0[1]);
    let seen = linear(with.get_pixel(x, y).0[1]);
    (0.1..0.98)
        .contains(&full)
        .then_some((seen / full).min(1.0))
}

/// Returns the linear value of a component of kiss3d's images.
fn linear(component: u8) -> f64 {
    (f64::from(component) / 255.0).powf(2.2)
}
