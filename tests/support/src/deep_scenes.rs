//! Defines the scenes that are seen to the horizon, which a single cascade does not suit.

use glam::{DVec3, Vec3};

use crate::camera;
use crate::mesh::Mesh;
use crate::random::Random;
use crate::scene::{Light, Scene};
use crate::scenes::FOV_Y_RADIANS;

/// Returns a few hundred houses, seen from above their roofs.
pub fn town() -> Scene {
    let mut random = Random::new(6);
    let mut meshes = vec![Mesh::floor(0.0, 300.0)];
    for row in 0..18 {
        for column in 0..18 {
            let foot = Vec3::new(
                24.0 * (column as f32 - 8.5) + random.between(-2.0, 2.0),
                0.0,
                24.0 * (row as f32 - 8.5) + random.between(-2.0, 2.0),
            );
            let size = Vec3::new(
                random.between(7.0, 14.0),
                random.between(4.0, 22.0),
                random.between(7.0, 14.0),
            );
            meshes.push(Mesh::standing_box(foot, size, random.between(-0.2, 0.2)));
        }
    }
    Scene {
        name: "town",
        meshes,
        light: Light::sun(Vec3::new(0.6, -0.8, 0.35)),
        camera: camera::looking(
            Vec3::new(6.0, 34.0, 120.0),
            Vec3::new(-4.0, 0.0, 40.0),
            FOV_Y_RADIANS,
        ),
        origin: DVec3::ZERO,
    }
}

/// Returns a street between houses, seen by someone who stands in it: lampposts and bins beside the
/// eye, and houses up to the horizon.
pub fn street() -> Scene {
    let mut random = Random::new(11);
    let mut meshes = vec![Mesh::floor(0.0, 400.0)];
    for index in 0..28 {
        let along = 12.0 - 12.0 * index as f32;
        for side in [-1.0, 1.0] {
            let depth = random.between(7.0, 10.0);
            let foot = Vec3::new(side * (7.5 + 0.5 * depth), 0.0, along);
            let size = Vec3::new(depth, random.between(4.0, 15.0), random.between(7.0, 11.0));
            meshes.push(Mesh::standing_box(foot, size, 0.0));
            let post = Vec3::new(side * 4.5, 0.0, along + 4.0);
            meshes.push(Mesh::standing_box(post, Vec3::new(0.14, 4.5, 0.14), 0.3));
            let bin = Vec3::new(
                side * random.between(3.0, 5.0),
                0.0,
                along - random.between(0.0, 6.0),
            );
            let size = Vec3::new(0.5, random.between(0.5, 1.1), 0.4);
            meshes.push(Mesh::standing_box(bin, size, index as f32));
        }
    }
    Scene {
        name: "street",
        meshes,
        light: Light::sun(Vec3::new(0.45, -0.8, -0.5)),
        camera: camera::looking(
            Vec3::new(1.2, 1.7, 10.0),
            Vec3::new(-1.0, 2.0, -60.0),
            FOV_Y_RADIANS,
        ),
        origin: DVec3::ZERO,
    }
}

/// Returns posts on open ground, as many in a metre before the eye as in a hundred metres far away.
pub fn meadow() -> Scene {
    let mut random = Random::new(12);
    let mut meshes = vec![Mesh::floor(0.0, 300.0)];
    for index in 0..150 {
        let distance = 2.0 * 125f32.powf(random.between(0.0, 1.0));
        let (sin, cos) = random.between(-0.6, 0.6).sin_cos();
        let foot = Vec3::new(sin * distance, 0.0, -cos * distance);
        let width = random.between(0.08, 0.4);
        let size = Vec3::new(width, random.between(0.4, 2.5), width);
        meshes.push(Mesh::standing_box(foot, size, index as f32));
    }
    Scene {
        name: "meadow",
        meshes,
        light: Light::sun(Vec3::new(-0.7, -0.6, 0.3)),
        camera: camera::looking(
            Vec3::new(0.0, 1.7, 0.0),
            Vec3::new(0.0, 0.6, -12.0),
            FOV_Y_RADIANS,
        ),
        origin: DVec3::ZERO,
    }
}
