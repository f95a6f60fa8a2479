//! Generates a town: streets in a grid, blocks between them, and what stands on each.
//!
//! ```text
//! plot.rs  what stands on one block
//! ```

mod plot;

use glam::{Vec2, Vec3};
use shadow_support::random::Random;
use wgpu_shadows::Aabb;

use crate::mesh::Instance;
pub use plot::BLOCK_SIDE;
use plot::{Part, Shape};

/// Is the distance from the middle of one street to the middle of the next.
pub const STREET_SPACING: f32 = BLOCK_SIDE + 14.0;

/// Is the height of the kerbs.
const KERB: f32 = 0.15;

/// Holds the town, as instances of cubes from -1 to 1 and of spheres of radius 1. Streets run along
/// x and z; one of each passes through the middle.
pub struct Plan {
    /// Are cubes that only receive: the streets and the pavements.
    pub ground: Vec<Instance>,
    /// Are cubes.
    pub houses: Vec<Instance>,
    /// Are spheres.
    pub domes: Vec<Instance>,
    /// Bounds streets and pavements.
    pub ground_bounds: Aabb,
}

impl Plan {
    /// Generates a town of `blocks` by `blocks` blocks.
    pub fn new(blocks: i32) -> Self {
        let mut random = Random::new(5);
        let ground_bounds = ground(blocks);
        let mut pavements = vec![street(&ground_bounds)];
        let (mut boxes, mut domes) = (Vec::new(), Vec::new());
        for (column, row) in (0..blocks).flat_map(|x| (0..blocks).map(move |z| (x, z))) {
            let cell = Vec2::new(column as f32, row as f32) + 0.5 - blocks as f32 * 0.5;
            let center = cell * STREET_SPACING;
            let half = Vec2::splat(BLOCK_SIDE * 0.5);
            let slab = Vec3::new(0.46, 0.45, 0.43);
            pavements.push(plot::upright(center, half, 0.0, KERB, slab));
            // Buildings are higher toward the middle.
            let eaves = 9.0 + 16.0 * (-cell.length_squared() / 30.0).exp();
            for part in plot::block(&mut random, center, eaves) {
                match part.shape {
                    Shape::Box => boxes.push(part),
                    Shape::Dome => domes.push(part),
                }
            }
        }
        let instances = |parts: Vec<Part>| parts.into_iter().map(|part| part.instance).collect();
        Self {
            ground: instances(pavements),
            houses: instances(boxes),
            domes: instances(domes),
            ground_bounds,
        }
    }
}

/// Returns the bounds of streets and pavements.
fn ground(blocks: i32) -> Aabb {
    let reach = blocks as f32 * 0.5 * STREET_SPACING;
    Aabb::new(
        Vec3::new(-reach, 0.0, -reach),
        Vec3::new(reach, KERB, reach),
    )
}

/// Returns one slab of asphalt under everything.
fn street(ground_bounds: &Aabb) -> Part {
    let half = ground_bounds.max.x;
    let asphalt = Vec3::new(0.20, 0.20, 0.21);
    plot::upright(Vec2::ZERO, Vec2::splat(half), -1.0, 0.0, asphalt)
}
