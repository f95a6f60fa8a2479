//! Builds a town with somebody who walks along the middle street.

use example_support::mesh::{Instance, cube, sphere};
use example_support::town::Plan;
use glam::{Mat4, Quat, Vec3};

use super::{Light, Model, Role, Scene, day, plain};
use crate::settings::SideSettings;
use crate::viewpoint::Viewpoint;

/// Is the number of blocks along each side.
const BLOCKS: i32 = 10;

/// Is the walker's speed in metres a second, and the length of the way before the walker turns.
const SPEED: f32 = 1.4;
const WAY: f32 = 12.0;

pub fn scene() -> Scene {
    let plan = Plan::new(BLOCKS);
    let walker = |path: fn(f32) -> Vec<Instance>, mesh| Model {
        path: Some(path),
        ..Model::solid(mesh, path(0.0))
    };
    let models = vec![
        Model::of(Role::Ground, cube(), plan.ground),
        Model::solid(cube(), plan.houses),
        Model::solid(sphere(16), plan.domes),
        walker(limbs, cube()),
        walker(head, sphere(8)),
    ];
    let eye = Vec3::new(2.6, 2.2, 47.0);
    let viewpoint = Viewpoint::new(eye, eye + Vec3::new(-1.1, 0.3, -10.0), 0.9);
    Scene {
        light: Light {
            haze: 2500.0,
            ..Light::DAY
        },
        extent: 300.0,
        sides: [SideSettings::textbook(140.0), SideSettings::library()],
        ..day("town", models, viewpoint, Vec3::new(0.10, 0.62, 0.80))
    }
}

/// Returns where the walker stands at a time, and the phase of the step in radians.
fn place(time: f32) -> (Mat4, f32) {
    let walked = (time * SPEED).rem_euclid(2.0 * WAY);
    let (along, turn) = if walked < WAY {
        (walked, 0.0)
    } else {
        (2.0 * WAY - walked, std::f32::consts::PI)
    };
    let place = Vec3::new(1.7, 0.0, 41.0 - along);
    (
        Mat4::from_rotation_translation(Quat::from_rotation_y(turn), place),
        time * SPEED * 4.0,
    )
}

/// Returns trunk, legs and arms, as cubes.
fn limbs(time: f32) -> Vec<Instance> {
    let (place, phase) = place(time);
    let coat = Vec3::new(0.55, 0.12, 0.10);
    let trousers = Vec3::new(0.10, 0.11, 0.16);
    let part = |joint: Vec3, swing: f32, middle: Vec3, half: Vec3, albedo| {
        let matrix = place
            * Mat4::from_translation(joint)
            * Mat4::from_rotation_x(swing)
            * Mat4::from_translation(middle)
            * Mat4::from_scale(half);
        plain(matrix, albedo)
    };
    let swing = 0.5 * phase.sin();
    let mut parts = vec![part(
        Vec3::new(0.0, 1.15, 0.0),
        0.0,
        Vec3::ZERO,
        Vec3::new(0.21, 0.32, 0.12),
        coat,
    )];
    for side in [-1.0, 1.0] {
        let leg = Vec3::new(0.11 * side, 0.86, 0.0);
        let half = Vec3::new(0.085, 0.43, 0.09);
        let down = Vec3::new(0.0, -0.43, 0.0);
        parts.push(part(leg, swing * side, down, half, trousers));
        let arm = Vec3::new(0.28 * side, 1.42, 0.0);
        let half = Vec3::new(0.06, 0.32, 0.06);
        let down = Vec3::new(0.0, -0.30, 0.0);
        parts.push(part(arm, -0.8 * swing * side, down, half, coat));
    }
    parts
}

fn head(time: f32) -> Vec<Instance> {
    let (place, _) = place(time);
    let matrix = place
        * Mat4::from_translation(Vec3::new(0.0, 1.63, 0.0))
        * Mat4::from_scale(Vec3::new(0.11, 0.14, 0.12));
    vec![plain(matrix, Vec3::new(0.62, 0.44, 0.34))]
}
