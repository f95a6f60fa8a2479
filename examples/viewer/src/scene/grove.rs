//! Builds a grove whose leaves are cut out of cards.

use example_support::mesh::{Instance, cube};
use glam::{EulerRot, Mat4, Quat, Vec3};
use shadow_support::random::Random;

use super::{Model, Role, Scene, cuboid, day, plain};
use crate::leaves;
use crate::settings::SideSettings;
use crate::viewpoint::Viewpoint;

/// Lists where trees stand, and the height of their trunks, in metres.
const TREES: [([f32; 2], f32); 7] = [
    ([-4.6, 1.2], 2.6),
    ([-2.2, -3.4], 3.4),
    ([0.6, -0.6], 2.9),
    ([3.0, 2.2], 2.3),
    ([4.4, -2.6], 3.1),
    ([-5.8, -4.4], 2.8),
    ([7.2, 0.4], 2.5),
];

/// Is the number of cards of a crown.
const CARDS: u32 = 54;

pub fn scene() -> Scene {
    let mut floor = cuboid(
        Vec3::new(0.0, -0.25, 0.0),
        Vec3::new(13.0, 0.25, 9.0),
        Vec3::new(0.58, 0.56, 0.50),
    );
    floor.checker = 0.07;
    let mut boxes = vec![floor];
    for ([x, z], height) in TREES {
        let half = Vec3::new(0.13, 0.5 * height + 0.3, 0.13);
        boxes.push(cuboid(
            Vec3::new(x, half.y, z),
            half,
            Vec3::new(0.30, 0.22, 0.15),
        ));
    }
    // A bench in the shade.
    let wood = Vec3::new(0.50, 0.34, 0.20);
    let bench = |x, y, z, half: [f32; 3]| cuboid(Vec3::new(x, y, z), half.into(), wood);
    boxes.extend([
        bench(-0.4, 0.45, 3.2, [1.1, 0.05, 0.25]),
        bench(-1.3, 0.20, 3.2, [0.06, 0.20, 0.22]),
        bench(0.5, 0.20, 3.2, [0.06, 0.20, 0.22]),
    ]);
    let mut random = Random::new(5);
    let crowns = TREES.map(|([x, z], height)| {
        let cards = crown(&mut random, Vec3::new(x, height + 0.7, z));
        Model::of(Role::Leaves, leaves::outlines(), cards)
    });
    let models = std::iter::once(Model::solid(cube(), boxes));
    let viewpoint = Viewpoint::new(Vec3::new(0.6, 5.4, 14.0), Vec3::new(0.3, 1.7, -0.4), 0.72);
    Scene {
        sides: [SideSettings::textbook(14.0), SideSettings::library()],
        ..day(
            "grove",
            models.chain(crowns).collect(),
            viewpoint,
            Vec3::new(0.45, 0.80, 0.30),
        )
    }
}

/// Returns cards that are turned anyhow, in a ball about `middle`.
fn crown(random: &mut Random, middle: Vec3) -> Vec<Instance> {
    let mut cards = Vec::new();
    for _ in 0..CARDS {
        let mut angle = || random.between(-std::f32::consts::PI, std::f32::consts::PI);
        let turn = Quat::from_euler(EulerRot::YXZ, angle(), angle(), angle());
        let away = Vec3::new(1.25, 1.0, 1.25) * random.between(0.2, 1.0).cbrt();
        let place = middle + turn * Vec3::Z * away;
        let green = Vec3::new(0.20, 0.40, 0.12) * random.between(0.7, 1.3);
        let matrix = Mat4::from_rotation_translation(turn, place)
            * Mat4::from_scale(Vec3::splat(random.between(0.35, 0.6)));
        cards.push(plain(matrix, green));
    }
    cards
}
