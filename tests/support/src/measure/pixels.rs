//! Finds what a camera sees, pixel by pixel, with the truth about each.

use glam::DVec3;

use super::edge;
use super::parallel;
use crate::camera::{self, PixelRay};
use crate::scene::Scene;
use crate::truth::World;

/// Is a visible surface point that faces the light and lies within its reach.
#[derive(Clone, Copy, Debug)]
pub struct Pixel {
    /// Is its index in the image, row by row from the top.
    pub index: u32,
    /// Is in render space.
    pub position: DVec3,
    /// Is the geometric normal, toward the camera.
    pub normal: DVec3,
    /// Is the true visibility of the light, in [0, 1].
    pub visibility: f64,
    /// Is the distance toward the light of what hides its middle; `None` where that is seen.
    pub occluder_world: Option<f64>,
    /// Is the distance across the light's rays to the nearest position on the tangent plane where
    /// the middle of the light turns from seen to hidden or back; infinite where that is farther
    /// than any filter reaches.
    pub edge_world: f64,
}

/// Limits the work for the truth.
#[derive(Clone, Copy, Debug)]
pub struct Effort {
    /// Is the width and height of the image.
    pub picture: [u32; 2],
    /// Is the number of points of a light with extent, per side of their square.
    pub disc_side: u32,
    /// Is the number of rays per ring in the search for edges; with 0 none are searched for, and
    /// errors at edges then count as acne and leaks.
    pub ring_rays: u32,
}

/// Returns the pixels that count, row by row: those where a surface faces the light.
pub fn visible(scene: &Scene, world: &World, effort: &Effort) -> Vec<Pixel> {
    let rays: Vec<_> = (0..)
        .zip(camera::pixel_rays(&scene.camera, effort.picture))
        .collect();
    let rings = edge::Rings::of_scene(scene, effort.ring_rays);
    let label = format!("truth of {}", scene.name);
    let pixels = parallel::map(&label, &rays, |&(index, ray)| {
        pixel(world, index, &ray, effort.disc_side, &rings)
    });
    pixels.into_iter().flatten().collect()
}

/// Returns what a ray through the image meets, if that counts. `disc_side` and the rays of `rings`
/// are those of [`Effort`].
pub fn pixel(
    world: &World,
    index: u32,
    ray: &PixelRay,
    disc_side: u32,
    rings: &edge::Rings,
) -> Option<Pixel> {
    let hit = world.first_hit(ray.start, ray.direction, ray.reach)?;
    let position = ray.start + ray.direction * hit.distance;
    let (toward_light, _) = world.light().toward_light_from(position);
    if hit.normal.dot(toward_light) <= 0.0 || !world.light().reaches(position) {
        return None;
    }
    Some(Pixel {
        index,
        position,
        normal: hit.normal,
        visibility: world.visibility(position, hit.normal, disc_side),
        occluder_world: world.occluder(position, hit.normal),
        edge_world: edge::distance(world, position, hit.normal, rings),
    })
}
