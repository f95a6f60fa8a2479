//! Defines the scenes: small and generated, each about one thing that is hard for shadow maps.

use glam::{DVec3, Vec3};

use crate::camera;
use crate::deep_scenes;
use crate::mesh::Mesh;
use crate::random::Random;
use crate::scene::{Light, SUN_DIAMETER_RADIANS, Scene};

/// Is the field of view of most cameras, from the lower to the upper edge of the image.
pub(crate) const FOV_Y_RADIANS: f32 = 0.9;

/// Returns all scenes, in the order of the tables.
pub fn all() -> Vec<Scene> {
    vec![
        boxes("boxes", DVec3::ZERO),
        curved(),
        thin(),
        contact(),
        grazing(),
        deep_scenes::town(),
        deep_scenes::street(),
        deep_scenes::meadow(),
        boxes("far", DVec3::new(1e5, 250.0, -1e5)),
        sheets(),
        spot(),
        point(),
        soft(),
    ]
}

/// Returns boxes on level ground under an afternoon sun, far from the world's origin where `origin`
/// is.
pub fn boxes(name: &'static str, origin: DVec3) -> Scene {
    let mut random = Random::new(1);
    let mut meshes = vec![Mesh::floor(0.0, 25.0)];
    for index in 0..24 {
        let foot = Vec3::new(
            random.between(-11.0, 11.0),
            0.0,
            random.between(-11.0, 11.0),
        );
        let size = Vec3::new(
            random.between(0.5, 2.0),
            random.between(0.5, 4.0),
            random.between(0.5, 2.0),
        );
        meshes.push(Mesh::standing_box(foot, size, index as f32));
    }
    Scene {
        name,
        meshes,
        light: Light::sun(Vec3::new(-0.7, -0.8, 0.5)),
        camera: camera::looking(
            Vec3::new(5.0, 7.0, 10.0),
            Vec3::new(0.0, 0.0, 0.0),
            FOV_Y_RADIANS,
        ),
        origin,
    }
}

/// Returns rolling ground and spheres: every texel spans a range of slopes.
fn curved() -> Scene {
    let height = |x: f32, z: f32| 1.4 * (0.35 * x).sin() * (0.28 * z + 0.5).cos() + 0.02 * x;
    let mut random = Random::new(2);
    let mut meshes = vec![Mesh::terrain(20.0, 96, height)];
    for _ in 0..22 {
        let (x, z) = (random.between(-12.0, 12.0), random.between(-12.0, 12.0));
        let radius = random.between(0.4, 1.4);
        let middle = Vec3::new(x, height(x, z) + 0.8 * radius, z);
        meshes.push(Mesh::sphere(middle, radius, 24));
    }
    Scene {
        name: "curved",
        meshes,
        light: Light::sun(Vec3::new(0.7, -0.5, 0.4)),
        camera: camera::looking(
            Vec3::new(-4.0, 8.0, 10.0),
            Vec3::new(0.0, -0.5, 0.0),
            FOV_Y_RADIANS,
        ),
        origin: DVec3::ZERO,
    }
}

/// Returns fences of posts and rails, and wires overhead: shadows about as wide as a texel.
fn thin() -> Scene {
    let mut meshes = vec![Mesh::floor(0.0, 20.0)];
    for row in 0..3 {
        let z = 4.0 * row as f32 - 5.0;
        for post in 0..40 {
            let x = 0.4 * post as f32 - 8.0;
            meshes.push(Mesh::cuboid(
                Vec3::new(x, 0.0, z),
                Vec3::new(x + 0.05, 1.2, z + 0.03),
            ));
        }
        for height in [0.3, 1.0] {
            meshes.push(Mesh::cuboid(
                Vec3::new(-8.0, height, z + 0.03),
                Vec3::new(8.0, height + 0.08, z + 0.05),
            ));
        }
    }
    for wire in 0..6 {
        let x = 1.5 * wire as f32 - 4.0;
        meshes.push(Mesh::rod(
            Vec3::new(x, 4.0, -9.0),
            Vec3::new(x + 2.0, 3.6, 9.0),
            0.02,
            8,
        ));
    }
    Scene {
        name: "thin",
        meshes,
        light: Light::sun(Vec3::new(0.35, -1.0, 0.5)),
        camera: camera::looking(
            Vec3::new(5.0, 3.2, 9.0),
            Vec3::new(0.0, 0.3, 0.0),
            FOV_Y_RADIANS,
        ),
        origin: DVec3::ZERO,
    }
}

/// Returns boxes and plates of one to eight centimetres that lie on the ground: too much bias
/// removes their shadows.
fn contact() -> Scene {
    let mut random = Random::new(4);
    let mut meshes = vec![Mesh::floor(0.0, 12.0)];
    for index in 0..90 {
        let foot = Vec3::new(random.between(-5.0, 5.0), 0.0, random.between(-5.0, 5.0));
        let thickness = [0.01, 0.02, 0.04, 0.08][index % 4];
        let size = if index % 5 == 0 {
            Vec3::new(0.5, random.between(0.3, 1.0), 0.5)
        } else {
            Vec3::new(
                random.between(0.2, 0.9),
                thickness,
                random.between(0.2, 0.9),
            )
        };
        meshes.push(Mesh::standing_box(foot, size, 0.7 * index as f32));
    }
    Scene {
        name: "contact",
        meshes,
        light: Light::sun(Vec3::new(-0.8, -0.55, 0.45)),
        camera: camera::looking(
            Vec3::new(0.8, 3.2, 4.2),
            Vec3::new(0.0, 0.0, 0.3),
            FOV_Y_RADIANS,
        ),
        origin: DVec3::ZERO,
    }
}

/// Returns a scene under a sun four degrees above the horizon.
fn grazing() -> Scene {
    let mut random = Random::new(5);
    let mut meshes = vec![Mesh::floor(0.0, 25.0)];
    for index in 0..40 {
        let foot = Vec3::new(
            random.between(-10.0, 10.0),
            0.0,
            random.between(-10.0, 10.0),
        );
        let side = random.between(0.2, 0.8);
        let size = Vec3::new(side, random.between(0.1, 0.5), side);
        meshes.push(Mesh::standing_box(foot, size, index as f32));
    }
    let elevation = 4f32.to_radians();
    Scene {
        name: "grazing",
        meshes,
        light: Light::sun(Vec3::new(0.8, -elevation.tan(), 0.6)),
        camera: camera::looking(
            Vec3::new(-3.0, 6.0, 10.0),
            Vec3::new(0.0, 0.0, 0.0),
            FOV_Y_RADIANS,
        ),
        origin: DVec3::ZERO,
    }
}

/// Returns open sheets, some of them a few centimetres apart: sails, leaves and cloths without an
/// inside.
fn sheets() -> Scene {
    let mut random = Random::new(7);
    let mut meshes = vec![Mesh::floor(0.0, 15.0)];
    for _ in 0..50 {
        let corner = Vec3::new(
            random.between(-6.0, 6.0),
            random.between(0.1, 2.5),
            random.between(-6.0, 6.0),
        );
        let mut edge = |length: f32| {
            Vec3::new(
                random.between(-length, length),
                random.between(-0.4, 0.4),
                random.between(-length, length),
            )
        };
        let (u, v) = (edge(1.2), edge(1.2));
        let below = Vec3::new(0.0, -0.06, 0.0);
        meshes.push(Mesh::sheet(corner, u, v).joined(Mesh::sheet(corner + below, u, v)));
    }
    Scene {
        name: "sheets",
        meshes,
        light: Light::sun(Vec3::new(-0.4, -1.0, 0.5)),
        camera: camera::looking(
            Vec3::new(3.0, 5.0, 7.0),
            Vec3::new(0.0, 0.3, 0.0),
            FOV_Y_RADIANS,
        ),
        origin: DVec3::ZERO,
    }
}

/// Returns a spot light over a table of boxes.
fn spot() -> Scene {
    let mut random = Random::new(8);
    let mut meshes = vec![Mesh::floor(0.0, 8.0)];
    for index in 0..20 {
        let foot = Vec3::new(random.between(-3.0, 3.0), 0.0, random.between(-3.0, 3.0));
        let size = Vec3::new(
            random.between(0.2, 0.8),
            random.between(0.2, 1.5),
            random.between(0.2, 0.8),
        );
        meshes.push(Mesh::standing_box(foot, size, index as f32));
    }
    Scene {
        name: "spot",
        meshes,
        light: Light::Spot {
            position_world: DVec3::new(2.5, 5.0, 1.5),
            direction: Vec3::new(-0.5, -1.0, -0.3),
            outer_angle_radians: 0.65,
            range: 15.0,
            radius_world: 0.0,
        },
        camera: camera::looking(
            Vec3::new(2.0, 4.0, 4.6),
            Vec3::new(-0.2, 0.1, 0.2),
            FOV_Y_RADIANS,
        ),
        origin: DVec3::ZERO,
    }
}

/// Returns a point light in a room with columns: all six faces of the cube receive.
fn point() -> Scene {
    let mut meshes = vec![Mesh::cuboid(
        Vec3::new(-5.0, 0.0, -5.0),
        Vec3::new(5.0, 4.0, 5.0),
    )];
    for index in 0..8 {
        let angle = std::f32::consts::TAU * index as f32 / 8.0 + 0.2;
        let foot = Vec3::new(3.2 * angle.cos(), 0.0, 3.2 * angle.sin());
        meshes.push(Mesh::standing_box(foot, Vec3::new(0.4, 4.0, 0.4), angle));
        let foot = Vec3::new(1.9 * angle.cos(), 0.0, 1.9 * angle.sin());
        meshes.push(Mesh::standing_box(foot, Vec3::splat(0.5), 2.0 * angle));
    }
    meshes.push(Mesh::sphere(Vec3::new(0.9, 3.0, 0.4), 0.3, 24));
    Scene {
        name: "point",
        meshes,
        light: Light::Point {
            position_world: DVec3::new(0.3, 2.1, -0.2),
            range: 12.0,
            radius_world: 0.0,
        },
        camera: camera::looking(Vec3::new(-4.2, 3.2, 4.4), Vec3::new(0.8, 1.2, -0.6), 1.3),
        origin: DVec3::ZERO,
    }
}

/// Returns masts and boxes under a sun of its true width, about half a degree, which shows what a
/// hard map misses of the penumbra.
fn soft() -> Scene {
    let mut random = Random::new(9);
    let mut meshes = vec![Mesh::floor(0.0, 25.0)];
    for index in 0..14 {
        let foot = Vec3::new(random.between(-9.0, 9.0), 0.0, random.between(-9.0, 9.0));
        let size = if index % 3 == 0 {
            Vec3::new(0.3, random.between(6.0, 12.0), 0.3)
        } else {
            Vec3::new(random.between(0.6, 2.0), random.between(1.0, 6.0), 1.0)
        };
        meshes.push(Mesh::standing_box(foot, size, index as f32));
    }
    Scene {
        name: "soft",
        meshes,
        light: Light::Sun {
            direction: Vec3::new(-0.7, -0.9, 0.4),
            angular_diameter_radians: SUN_DIAMETER_RADIANS,
        },
        camera: camera::looking(
            Vec3::new(4.0, 6.5, 9.0),
            Vec3::new(-0.5, 0.0, 0.5),
            FOV_Y_RADIANS,
        ),
        origin: DVec3::ZERO,
    }
}
