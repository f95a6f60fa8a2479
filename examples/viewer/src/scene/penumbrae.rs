//! Builds a terrace of poles, slats and balls at many heights, under a large light.

use example_support::mesh::{cube, sphere};
use glam::{Mat4, Quat, Vec3};
use wgpu_shadows::Filter;

use super::{Model, Scene, cuboid, day, plain};
use crate::settings::SideSettings;
use crate::viewpoint::Viewpoint;

pub fn scene() -> Scene {
    let mut floor = cuboid(
        Vec3::new(0.0, -0.25, 0.0),
        Vec3::new(12.0, 0.25, 8.0),
        Vec3::new(0.62, 0.60, 0.56),
    );
    floor.checker = 0.07;
    let wood = Vec3::new(0.50, 0.34, 0.20);
    let mut boxes = vec![floor];
    // Poles of one to six metres: the higher the end, the wider its penumbra.
    for index in 0..6 {
        let height = 0.5 + 0.5 * index as f32;
        let place = Vec3::new(-5.2 + 1.1 * index as f32, height, 1.4);
        boxes.push(cuboid(place, Vec3::new(0.06, height, 0.06), wood));
    }
    // A roof of slats on four posts.
    for index in 0..12 {
        let place = Vec3::new(2.2 + 0.32 * index as f32, 2.6, -1.2);
        boxes.push(cuboid(place, Vec3::new(0.05, 0.05, 1.8), wood));
    }
    for (x, z) in [(2.1, -2.9), (2.1, 0.5), (5.8, -2.9), (5.8, 0.5)] {
        let half = Vec3::new(0.07, 1.3, 0.07);
        boxes.push(cuboid(Vec3::new(x, 1.3, z), half, wood));
    }
    // A board that leans, from contact to a height of two metres.
    let lean =
        Mat4::from_rotation_translation(Quat::from_rotation_z(0.5), Vec3::new(-4.2, 0.95, -1.9))
            * Mat4::from_scale(Vec3::new(2.0, 0.04, 0.6));
    boxes.push(plain(lean, Vec3::new(0.30, 0.42, 0.55)));
    let ball = |x: f32, height: f32, z: f32, radius: f32, albedo: [f32; 3]| {
        let place = Vec3::new(x, height, z);
        let matrix = Mat4::from_translation(place) * Mat4::from_scale(Vec3::splat(radius));
        plain(matrix, albedo.into())
    };
    let balls = vec![
        ball(2.6, 0.4, 2.6, 0.4, [0.70, 0.25, 0.20]),
        ball(4.0, 1.2, 2.6, 0.4, [0.30, 0.50, 0.28]),
        ball(5.4, 2.4, 2.6, 0.4, [0.25, 0.40, 0.65]),
        ball(-0.6, 0.7, -2.4, 0.7, [0.66, 0.60, 0.30]),
    ];
    let models = vec![Model::solid(cube(), boxes), Model::solid(sphere(24), balls)];
    let viewpoint = Viewpoint::new(Vec3::new(0.4, 7.2, 15.0), Vec3::new(0.2, 0.6, -0.4), 0.72);
    let soft = SideSettings {
        filter: Filter::Pcss { light_size: 0.0 },
        ..SideSettings::library()
    };
    Scene {
        sun_degrees: 3.0,
        sides: [SideSettings::textbook(16.0), soft],
        ..day(
            "penumbrae",
            models,
            viewpoint,
            Vec3::new(-0.55, 0.62, -0.42),
        )
    }
}
