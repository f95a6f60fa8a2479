//! Builds a hall of 24 by 14 by 6 metres: floor and walls as flat meshes, a ceiling with a
//! skylight, columns, and objects.
//!
//! ```text
//! lights.rs    where its lights are, and how they move
//! lights.wgsl  the fragment stage that loops over them
//! ```

pub mod lights;

use glam::{Mat4, Quat, Vec3};

use crate::mesh::{Instance, Vertex, cube, sphere, square};

/// Are half the hall's extent along x and z, and its height.
const HALF_LENGTH: f32 = 12.0;
const HALF_WIDTH: f32 = 7.0;
const HEIGHT: f32 = 6.0;

/// Is half the skylight's extent along x and z.
const SKYLIGHT: [f32; 2] = [8.0, 1.6];

/// Is the fragment stage of the hall, which loops over its lights. The text before it defines
/// Blinn-Phong, and the one before that `shadow_sun`, `shadow_spots` and `shadow_lamps`.
pub const FRAGMENT_WGSL: &str = include_str!("lights.wgsl");

/// Returns floor, walls, ceiling, columns and objects, each a mesh with its position.
pub fn parts() -> Vec<(Vec<Vertex>, Instance)> {
    let mut parts = Vec::new();
    let mut add = |mesh: Vec<Vertex>, render_from_model, albedo: [f32; 3], checker| {
        let instance = Instance {
            render_from_model,
            albedo: albedo.into(),
            checker,
        };
        parts.push((mesh, instance));
    };
    for (inward, center, half) in shell() {
        let transform = Mat4::from_translation(center) * Mat4::from_scale(half);
        let wall = square(inward, 0.0).to_vec();
        add(wall, transform, [0.66, 0.63, 0.58], 0.06);
    }
    let stone = [0.62, 0.60, 0.56];
    for transform in ceiling().into_iter().chain(columns()) {
        add(cube(), transform, stone, 0.0);
    }
    let colors = [
        [0.62, 0.36, 0.22],
        [0.30, 0.45, 0.62],
        [0.55, 0.52, 0.28],
        [0.42, 0.58, 0.40],
    ];
    for (index, (place, half, turn)) in (0..).zip(CRATES) {
        let transform = Mat4::from_scale_rotation_translation(
            Vec3::splat(half),
            Quat::from_rotation_y(turn),
            Vec3::from_array(place) + Vec3::Y * half,
        );
        add(cube(), transform, colors[index % 4], 0.0);
    }
    for (index, (place, radius)) in (0..).zip(BALLS) {
        let center = Vec3::from_array(place) + Vec3::Y * radius;
        let transform = Mat4::from_translation(center) * Mat4::from_scale(Vec3::splat(radius));
        add(sphere(24), transform, colors[(index + 2) % 4], 0.0);
    }
    parts
}

/// Is where the camera stands at one end, under the ceiling, and what it looks at along the hall.
pub const EYE: Vec3 = Vec3::new(11.5, 4.5, 1.9);
pub const TARGET: Vec3 = Vec3::new(-2.0, 0.2, -0.9);
pub const FIELD_OF_VIEW_RADIANS: f32 = 1.05;

/// Returns floor and four walls: the direction that each faces, its middle, and half its extent.
fn shell() -> [(Vec3, Vec3, Vec3); 5] {
    let half = Vec3::new(HALF_LENGTH, HEIGHT * 0.5, HALF_WIDTH);
    let middle = Vec3::Y * HEIGHT * 0.5;
    [
        (Vec3::Y, Vec3::ZERO, half),
        (Vec3::X, middle - Vec3::X * HALF_LENGTH, half),
        (Vec3::NEG_X, middle + Vec3::X * HALF_LENGTH, half),
        (Vec3::Z, middle - Vec3::Z * HALF_WIDTH, half),
        (Vec3::NEG_Z, middle + Vec3::Z * HALF_WIDTH, half),
    ]
}

/// Returns four slabs around the skylight, and beams across it. The eaves keep the sun from the
/// foot of the walls, where these have no thickness that a texel could resolve.
fn ceiling() -> Vec<Mat4> {
    let slab = |low: [f32; 2], high: [f32; 2], thickness: f32| {
        let low = Vec3::new(low[0], HEIGHT, low[1]);
        let high = Vec3::new(high[0], HEIGHT + thickness, high[1]);
        Mat4::from_translation((low + high) * 0.5) * Mat4::from_scale((high - low) * 0.5)
    };
    let [x, z] = SKYLIGHT;
    let (end, side) = (HALF_LENGTH + 2.0, HALF_WIDTH + 2.0);
    let mut slabs = vec![
        slab([-end, -side], [end, -z], 0.3),
        slab([-end, z], [end, side], 0.3),
        slab([-end, -z], [-x, z], 0.3),
        slab([x, -z], [end, z], 0.3),
    ];
    slabs.extend([-4.8, -1.6, 1.6, 4.8].map(|at| slab([at - 0.12, -z], [at + 0.12, z], 0.25)));
    slabs
}

/// Returns two rows of five.
fn columns() -> impl Iterator<Item = Mat4> {
    let half = Vec3::new(0.32, HEIGHT * 0.5, 0.32);
    [-4.2, 4.2].into_iter().flat_map(move |z| {
        (-2..=2).map(move |index| {
            let place = Vec3::new(index as f32 * 4.4, half.y, z);
            Mat4::from_translation(place) * Mat4::from_scale(half)
        })
    })
}

/// Lists the position of each crate, half its side, and its rotation.
const CRATES: [([f32; 3], f32, f32); 10] = [
    ([-2.6, 0.0, 0.4], 0.55, 0.4),
    ([-2.4, 1.1, 0.5], 0.35, 0.9),
    ([1.8, 0.0, -1.7], 0.50, 0.2),
    ([4.2, 0.0, 1.2], 0.45, 1.1),
    ([-6.5, 0.0, -1.6], 0.70, 0.6),
    ([-8.2, 0.0, 1.8], 0.50, 0.1),
    ([6.6, 0.0, -3.4], 0.55, 0.7),
    ([7.4, 0.0, 2.6], 0.40, 0.3),
    ([0.3, 0.0, 5.4], 0.50, 0.5),
    ([-3.9, 0.0, -5.6], 0.60, 0.8),
];

/// Lists the position of each ball, and its radius.
const BALLS: [([f32; 3], f32); 6] = [
    ([0.2, 0.0, 1.3], 0.50),
    ([-4.6, 0.0, 1.9], 0.60),
    ([3.2, 0.0, -0.6], 0.35),
    ([5.8, 0.0, -0.8], 0.50),
    ([-0.9, 0.0, -3.0], 0.45),
    ([-9.4, 0.0, -0.8], 0.55),
];
