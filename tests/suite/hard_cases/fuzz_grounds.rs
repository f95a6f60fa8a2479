//! Generates grounds with boxes on them, and places to look at them from.

use glam::{DVec3, Vec3};
use proptest::prelude::*;

/// Generates half the side of a ground, from 1 to 1e5; its thickness, 0 for a sheet; and the least
/// corner and the size of each box on it. Some boxes are sunk into the ground.
pub fn ground() -> impl Strategy<Value = (f32, f32, Vec<(Vec3, Vec3)>)> {
    let half = (0.0..5.0_f64).prop_map(|exponent| 10_f64.powf(exponent) as f32);
    let thickness = prop_oneof![Just(0.0_f32), 0.001..5.0_f32];
    let corner = (
        -1.5..1.0_f32,
        prop_oneof![Just(0.0_f32), -0.05..0.0_f32],
        -1.5..1.0_f32,
    );
    let size = (0.05..0.8_f32, 0.2..1.5_f32, 0.05..0.8_f32);
    let boxes = prop::collection::vec((corner, size), 1..4).prop_map(|boxes| {
        let boxes = boxes.into_iter();
        boxes
            .map(|(corner, size)| (Vec3::from(corner), Vec3::from(size)))
            .collect::<Vec<_>>()
    });
    (half, thickness, boxes)
}

/// Generates a place to look at the boxes from.
pub fn eye() -> impl Strategy<Value = DVec3> {
    (2.0..5.0, 0.8..4.0, 0.0..std::f64::consts::TAU).prop_map(
        |(away, height, side): (f64, f64, f64)| {
            DVec3::new(away * side.cos(), height, away * side.sin())
        },
    )
}
