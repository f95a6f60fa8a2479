//! Generates what stands on one block: houses around a courtyard, or a tower on its square.

use glam::{Mat4, Quat, Vec2, Vec3};
use shadow_support::random::Random;

use crate::mesh::Instance;

/// Is the side of a block between its streets.
pub const BLOCK_SIDE: f32 = 56.0;

/// Is the depth of a house from the street to the courtyard.
const HOUSE_DEPTH: f32 = 12.0;

/// Is the width of the free pavement between a block's edge and its houses.
const PAVEMENT: f32 = 2.5;

/// Is the height of a storey; the windows of `city.wgsl` repeat with it.
const STOREY: f32 = 3.0;

/// Is the height of the wall above the ceiling of the last storey.
const PARAPET: f32 = 0.5;

/// Selects the appearance of a building.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Shape {
    Box,
    Dome,
}

/// Is a part of a building, with its position.
pub struct Part {
    pub shape: Shape,
    pub instance: Instance,
}

/// Returns the parts of the block around `center`. Houses reach to about `eaves` metres.
pub fn block(random: &mut Random, center: Vec2, eaves: f32) -> Vec<Part> {
    if random.chance(0.12) {
        tower(random, center, eaves)
    } else {
        courtyard(random, center, eaves)
    }
}

/// Returns a slab, a shaft on it and sometimes a dome on top.
fn tower(random: &mut Random, center: Vec2, eaves: f32) -> Vec<Part> {
    let stone = color(random);
    let half = random.between(7.0, 10.0);
    let top = roof(eaves * random.between(1.8, 3.2));
    let slab = roof(random.between(4.0, 7.0));
    let shaft = Vec2::splat(half);
    let mut parts = vec![
        upright(center, Vec2::splat(22.0), 0.0, slab, stone * 0.9),
        upright(center, shaft, slab, top, stone),
    ];
    if random.chance(0.65) {
        let radius = half * 0.8;
        let instance = Instance {
            render_from_model: Mat4::from_scale_rotation_translation(
                Vec3::splat(radius),
                Quat::IDENTITY,
                Vec3::new(center.x, top, center.y),
            ),
            albedo: Vec3::new(0.30, 0.42, 0.36),
            checker: 0.0,
        };
        parts.push(Part {
            shape: Shape::Dome,
            instance,
        });
    } else {
        let crown = roof(top + random.between(4.0, 9.0));
        parts.push(upright(center, shaft * 0.55, top, crown, stone * 0.8));
    }
    parts
}

/// Returns rows of houses along four streets, with a gate left open here and there, and a shed in
/// the yard.
fn courtyard(random: &mut Random, center: Vec2, eaves: f32) -> Vec<Part> {
    let outer = BLOCK_SIDE * 0.5 - PAVEMENT;
    let middle = outer - HOUSE_DEPTH * 0.5;
    let inner = outer - HOUSE_DEPTH;
    let mut parts = Vec::new();
    for along_x in [true, false] {
        // The rows along x extend to the corners, and those along z lie between them.
        let reach = if along_x { outer } else { inner };
        for side in [-middle, middle] {
            let mut start = -reach;
            while start < reach - 1.0 {
                let width = random.between(9.0, 16.0);
                let width = if start + width > reach - 6.0 {
                    reach - start
                } else {
                    width
                };
                let place = start + width * 0.5;
                start += width;
                if random.chance(0.06) {
                    continue;
                }
                let height = roof(eaves * random.between(0.75, 1.3));
                let (offset, half) = if along_x {
                    (Vec2::new(place, side), Vec2::new(width, HOUSE_DEPTH) * 0.5)
                } else {
                    (Vec2::new(side, place), Vec2::new(HOUSE_DEPTH, width) * 0.5)
                };
                let plaster = color(random);
                parts.push(upright(center + offset, half, 0.0, height, plaster));
                if random.chance(0.4) {
                    parts.push(roof_room(random, center + offset, half, height, plaster));
                }
            }
        }
    }
    if random.chance(0.7) {
        let offset = Vec2::new(random.between(-6.0, 6.0), random.between(-6.0, 6.0));
        let half = Vec2::new(random.between(2.5, 5.0), random.between(2.5, 5.0));
        let height = STOREY + PARAPET;
        let wood = Vec3::new(0.40, 0.30, 0.22);
        parts.push(upright(center + offset, half, 0.0, height, wood));
    }
    parts
}

/// Returns a stairhead or a lift's machine room on a flat roof.
fn roof_room(random: &mut Random, house: Vec2, half: Vec2, bottom: f32, plaster: Vec3) -> Part {
    let aside = half * Vec2::new(random.between(-0.4, 0.4), random.between(-0.4, 0.4));
    let half = half * random.between(0.2, 0.45);
    let top = bottom + STOREY;
    upright(house + aside, half, bottom, top, plaster * 0.85)
}

/// Returns a box from `bottom` to `top` over the ground rectangle of half size `half` around
/// `center` (x and z).
pub fn upright(center: Vec2, half: Vec2, bottom: f32, top: f32, albedo: Vec3) -> Part {
    let scale = Vec3::new(half.x, (top - bottom) * 0.5, half.y);
    let middle = Vec3::new(center.x, (top + bottom) * 0.5, center.y);
    Part {
        shape: Shape::Box,
        instance: Instance {
            render_from_model: Mat4::from_scale_rotation_translation(scale, Quat::IDENTITY, middle),
            albedo,
            checker: 0.0,
        },
    }
}

/// Returns the height of a roof at about `height`: whole storeys and a parapet.
fn roof(height: f32) -> f32 {
    (height / STOREY).round() * STOREY + PARAPET
}

/// Returns the colour of plaster, brick or stone.
fn color(random: &mut Random) -> Vec3 {
    let tint = random.between(0.0, 1.0);
    let brick = Vec3::new(0.50, 0.29, 0.21);
    let plaster = Vec3::new(0.66, 0.58, 0.44);
    let stone = Vec3::new(0.55, 0.56, 0.57);
    let mixed = if tint < 0.5 {
        brick.lerp(plaster, 2.0 * tint)
    } else {
        plaster.lerp(stone, 2.0 * tint - 1.0)
    };
    mixed * random.between(0.8, 1.1)
}
