//! Tests indices that no slot of a pool has: they are lit, whatever their product with the number
//! of views of a light is in 32 bits.

use glam::Vec3;
use shadow_support::probe::Point;
use wgpu_shadows::{Bias, Filter};

use crate::fixtures::ask::Ask;
use crate::fixtures::gpu::gpu;
use crate::fixtures::lights::{Kind, stage};

const CAPACITY: u32 = 2;

/// Are indices whose products with six are, in 32 bits: past the pool, 0, 2, -6, 2, and 6 for the
/// second light's own.
const NO_SLOTS: [u32; 6] = [
    CAPACITY,
    0x8000_0000,
    0xaaaa_aaab,
    u32::MAX,
    0x2aaa_aaab,
    0x8000_0001,
];

const VISIBILITY: &str = "shadow_lights(INDEX, point.position, point.normal)";
const VIEW: &str = "shadow_view_lights(INDEX, point.position)";

fn floor() -> Vec<Point> {
    (0..1600)
        .map(|index| {
            let step = |n: u32| n as f32 * 0.095 - 1.85;
            Point::new(Vec3::new(step(index % 40), 0.0, step(index / 40)), Vec3::Y)
        })
        .collect()
}

fn assert_lit(kind: Kind, filter: Filter) {
    let gpu = gpu();
    let light = kind.lit(gpu, &stage(gpu), filter, Bias::Auto);
    let lights = [("lights", light.maps())];
    let points = floor();
    let ask = |function: &str, index: u32| {
        let call = format!("f32({function})").replace("INDEX", &format!("{index}u"));
        Ask::new(gpu, &lights, &call).points(gpu, &points)
    };
    for index in 0..CAPACITY {
        let seen = ask(VISIBILITY, index);
        let dark = seen.iter().filter(|seen| **seen < 0.5).count();
        assert!(dark > 50, "{kind:?} {filter:?} slot {index}: {dark} dark");
    }
    let layers = if kind.has_cube() {
        6 * CAPACITY
    } else {
        CAPACITY
    };
    for index in NO_SLOTS {
        let seen = ask(VISIBILITY, index);
        let lit = seen.iter().filter(|seen| **seen == 1.0).count();
        assert_eq!(lit, points.len(), "{kind:?} {filter:?} index {index:#x}");
        let views = ask(VIEW, index);
        let none = views.iter().filter(|view| **view == layers as f32).count();
        assert_eq!(
            none,
            points.len(),
            "{kind:?} {filter:?} view of index {index:#x}"
        );
    }
}

#[test]
fn spots_that_are_in_no_slot_are_lit() {
    assert_lit(Kind::Spots, Filter::default());
}

#[test]
fn lamps_that_are_in_no_slot_are_lit() {
    assert_lit(Kind::Lamps, Filter::default());
}

#[test]
fn lamps_looked_at_along_directions_that_are_in_no_slot_are_lit() {
    assert_lit(Kind::Lamps, Filter::DirectionStar { radius: 0.05 });
}
