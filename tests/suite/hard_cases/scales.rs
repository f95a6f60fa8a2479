//! Tests the same scene in other units: no length in the library is absolute.

use glam::{DMat3, DVec3};

use crate::fixtures::frames::Coverage;

use super::stage::{
    MARGIN, Sun, Verdict, any_camera, bounds_of, boxes, level, meshes, scene, shining, world,
};
use super::table;

const MAP_SIZE: u32 = 256;

/// Texel sizes are quantized, so that a unit that is not a power of two moves the grid: edges may
/// move within a kernel, the texel may be one step larger (1.19 times), and every receiver whose
/// truth is the same for three texels around is correct.
#[test]
fn no_unit_is_special() {
    let light = DVec3::new(0.31, -1.0, 0.22);
    let world = world(light, any_camera());
    let mut places = world.floor_around_shadows(2000);
    places.retain(|place| place.abs().max_element() < 6.8);
    let mut all = Verdict::default();
    let mut sizes = Vec::new();
    for scale in [1e-6, 1e-3, 0.0254, 0.3048, 1.0, 3.0, 1e2, 1e3, 1e6, 1e9] {
        let turn = DMat3::IDENTITY * scale;
        let meshes = meshes(&boxes(), 7.4, turn, DVec3::ZERO);
        let scene = scene(&meshes);
        let mut sun = Sun::of_size(MAP_SIZE);
        sun.record(
            DVec3::ZERO,
            shining(world.light),
            Coverage::Bounds(bounds_of(&meshes)),
            &scene.list(),
            &[],
        );
        let texel = sun.texel() / scale;
        let scaled: Vec<_> = places.iter().map(|place| *place * scale).collect();
        let seen = sun.ask(&level(&scaled, DVec3::ZERO));
        let verdict = Verdict::of(&world, &places, &seen, texel, MARGIN);
        verdict.assert_right(&format!("unit {scale}"));
        all.add(&verdict);
        sizes.push(texel);
    }
    let least = sizes.iter().copied().fold(f64::INFINITY, f64::min);
    let largest = sizes.iter().copied().fold(0.0, f64::max);
    assert!(largest / least <= 1.19 * (1.0 + 1e-3), "{sizes:?}");
    table::record(
        "units of 1e-6 to 1e9",
        "settled receivers as the truth says, texels within a size step of 1.19",
        format!("{}, texels within {:.3}", all.words(), largest / least),
    );
}
