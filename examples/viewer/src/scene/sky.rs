//! Builds trees on a level ground of ten kilometres, under a sky dome that reaches around both.

use example_support::mesh::{Instance, Vertex, cube, sphere, square};
use glam::{Mat4, Vec3};
use shadow_support::random::Random;

use super::{Light, Model, Role, Scene, UNLIT, cuboid, day, plain};
use crate::settings::SideSettings;
use crate::viewpoint::Viewpoint;

/// Is half the side of the ground, and the radius of the dome, in metres.
const GROUND_HALF: f32 = 5000.0;
const DOME_RADIUS: f32 = 12_000.0;

pub fn scene() -> Scene {
    let ground = Instance {
        render_from_model: Mat4::from_scale(Vec3::splat(GROUND_HALF)),
        albedo: Vec3::new(0.26, 0.33, 0.16),
        checker: 0.0,
    };
    let dome = Instance {
        render_from_model: Mat4::from_scale(Vec3::splat(DOME_RADIUS)),
        albedo: Vec3::new(0.36, 0.52, 0.78),
        checker: UNLIT,
    };
    let (trunks, crowns) = trees();
    let mast = |x: f32, z: f32, height: f32| {
        let half = Vec3::new(0.4, 0.5 * height, 0.4);
        cuboid(Vec3::new(x, half.y, z), half, Vec3::new(0.55, 0.55, 0.57))
    };
    let mut boxes = trunks;
    boxes.extend((0..12).map(|index| mast(9.0, -20.0 - 130.0 * index as f32, 28.0)));
    boxes.push(cuboid(
        Vec3::new(-6.0, 1.6, -4.0),
        Vec3::new(2.6, 1.6, 2.0),
        Vec3::new(0.60, 0.50, 0.38),
    ));
    let inside: Vec<Vertex> = example_support::mesh::inside_out(&sphere(16));
    let models = vec![
        Model::of(Role::Ground, square(Vec3::Y, 0.0).to_vec(), vec![ground]),
        Model::of(Role::Glow, inside, vec![dome]),
        Model::solid(cube(), boxes),
        Model::solid(sphere(12), crowns),
    ];
    let viewpoint = Viewpoint::new(Vec3::new(4.0, 4.2, 16.0), Vec3::new(1.5, 4.4, 0.0), 0.9);
    Scene {
        light: Light {
            haze: 3500.0,
            ..Light::DAY
        },
        extent: 200.0,
        sides: [SideSettings::textbook(10_000.0), SideSettings::library()],
        ..day("sky", models, viewpoint, Vec3::new(-0.65, 0.42, 0.25))
    }
}

/// Returns trunks as cubes and crowns as spheres: near ones on both sides, and more in the
/// distance.
fn trees() -> (Vec<Instance>, Vec<Instance>) {
    let mut random = Random::new(9);
    let (mut trunks, mut crowns) = (Vec::new(), Vec::new());
    for index in 0..260 {
        let away = 12.0 * (1.022_f32).powi(index);
        let place = Vec3::new(away * random.between(-0.9, 0.9), 0.0, 18.0 - away);
        let size = random.between(0.7, 1.5);
        let bark = Vec3::new(0.25, 0.18, 0.12);
        let half = Vec3::new(0.16 * size, 1.3 * size, 0.16 * size);
        trunks.push(cuboid(place + Vec3::Y * half.y, half, bark));
        let middle = place + Vec3::Y * 3.6 * size;
        let scale = Vec3::new(1.3, 1.9, 1.3) * size;
        let leaves = Vec3::new(0.14, 0.30, 0.10) * random.between(0.8, 1.4);
        let matrix = Mat4::from_translation(middle) * Mat4::from_scale(scale);
        crowns.push(plain(matrix, leaves));
    }
    (trunks, crowns)
}
