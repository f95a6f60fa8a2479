//! Tests light along an axis of the world, and slightly off it: no direction is special.

use glam::{DMat3, DVec3};
use shadow_support::probe::Point;
use shadow_support::random::Random;

use super::stage::{Sun, bounds_of, boxes, differ, meshes, scene, shining};
use super::table;
use crate::fixtures::frames::Coverage;
use crate::fixtures::gpu::gpu;
use crate::fixtures::rounding::U;

const MAP_SIZE: u32 = 256;
const FLOOR_HALF: f32 = 6.1;

/// Returns the rotations that take light along -Y to light along each axis, by whole quarters, so
/// that coordinates stay exact.
fn turns() -> Vec<DMat3> {
    let columns = |x, y, z| DMat3::from_cols(x, y, z);
    vec![
        DMat3::IDENTITY,
        columns(DVec3::X, DVec3::NEG_Y, DVec3::NEG_Z),
        columns(DVec3::NEG_Y, DVec3::X, DVec3::Z),
        columns(DVec3::Y, DVec3::NEG_X, DVec3::Z),
        columns(DVec3::X, DVec3::Z, DVec3::NEG_Y),
        columns(DVec3::X, DVec3::NEG_Z, DVec3::Y),
    ]
}

/// Returns the visibilities of the same positions of the same scene, rotated by `turn`, under light
/// along the rotated -Y and `off` it.
fn look(turn: DMat3, off: DVec3, places: &[DVec3]) -> Vec<f32> {
    let meshes = meshes(&boxes(), FLOOR_HALF, turn, DVec3::ZERO);
    let scene = scene(&meshes);
    let mut sun = Sun::of_size(MAP_SIZE);
    let report = sun.record(
        DVec3::ZERO,
        shining(turn * DVec3::NEG_Y + off),
        Coverage::Bounds(bounds_of(&meshes)),
        &scene.list(),
        &[],
    );
    assert_eq!(report.passes, 1);
    let points: Vec<_> = places
        .iter()
        .map(|place| Point::rounded(turn * *place, turn * DVec3::Y))
        .collect();
    sun.ask(&points)
}

/// The texels of rotated maps lie on the same grid, so only rounding differs. A texel coordinate
/// errs by at most `14uN`: 6 roundings of a matrix row whose terms sum to at most 2N, and two of
/// its entries. With two maps, two axes and a sharpness of three that is `168uN` of visibility. A
/// deviation of 1e-7 moves a position by at most 1e-7 of the scene's 13 units, 0.05 to the texel,
/// hence 3e-5 texels. Texel centres within 1/256 of an edge may flip: at most one receiver in a
/// hundred, all of which lie where the boxes are.
#[test]
fn light_along_an_axis_shadows_as_along_any_other() {
    let mut random = Random::new(5);
    let places: Vec<_> = (0..4096)
        .map(|_| random.point(DVec3::new(-5.5, 0.0, -5.5), DVec3::new(5.5, 0.0, 5.5)))
        .map(|place| place.as_vec3().as_dvec3())
        .collect();
    let band = (168.0 * U * f64::from(MAP_SIZE) + 3.0 * 3e-5 + 1e-5) as f32;
    let upright = look(DMat3::IDENTITY, DVec3::ZERO, &places);
    let dark = upright.iter().filter(|seen| **seen == 0.0).count();
    assert!(dark > 100 && dark < 3500, "{dark} dark");
    let mut most = 0;
    for turn in turns() {
        let along = turn * DVec3::NEG_Y;
        let hairs = [DVec3::X, DVec3::Y, DVec3::Z]
            .into_iter()
            .filter(|axis| axis.dot(along) == 0.0)
            .flat_map(|axis| [axis * 1e-7, axis * -1e-7]);
        for off in hairs.chain([DVec3::ZERO]) {
            let seen = look(turn, off, &places);
            let flipped = upright
                .iter()
                .zip(&seen)
                .filter(|(a, b)| differ(**a, **b, band))
                .count();
            most = most.max(flipped);
            assert!(
                flipped * 100 <= places.len(),
                "light along {along} + {off} on {}: {flipped} of {} differ",
                gpu().describe(),
                places.len()
            );
        }
    }
    table::record(
        "light along an axis and 1e-7 off it",
        "as in the turned scene, at most 1 % of receivers beyond 168uN",
        format!("at most {most} of {} in 30 directions", places.len()),
    );
}
