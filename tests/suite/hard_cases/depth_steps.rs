//! Compares the same scenes in maps of 32 and of 16 bits, over short and long depth ranges.

use glam::{DMat3, DVec3};
use wgpu_shadows::{Aabb, CascadeLayout, DepthFormat, DirectionalShadowDescriptor};

use super::stage::{
    MARGIN, Sun, Verdict, any_camera, bounds_of, boxes, differ, level, meshes, scene, shining,
    world,
};
use super::table;
use crate::fixtures::frames::Coverage;
use crate::fixtures::gpu::gpu;

const FORMATS: [DepthFormat; 2] = [DepthFormat::Float32, DepthFormat::Unorm16];

/// Covers the scene from its top down to `range` below it.
fn down_to(range: f64, bounds: Aabb) -> Coverage {
    let mut covered = bounds;
    covered.min.y = covered.min.y.min(covered.max.y - range as f32);
    Coverage::Bounds(covered)
}

/// A step of depth matters only where caster and receiver are as close as that: at most one
/// receiver in a thousand has another visibility in 16 bits than in 32, in and around shadows.
#[test]
fn both_depth_formats_give_the_same_picture() {
    let (mut differences, mut asked) = (0, 0);
    for light in [
        DVec3::new(0.31, -1.0, 0.22),
        DVec3::new(-0.9, -0.7, 0.4),
        DVec3::new(0.05, -1.0, -0.6),
    ] {
        let world = world(light, any_camera());
        let meshes = meshes(&boxes(), 7.4, DMat3::IDENTITY, DVec3::ZERO);
        let scene = scene(&meshes);
        let mut places = world.floor_around_shadows(6000);
        places.retain(|place| place.abs().max_element() < 6.8);
        let points = level(&places, DVec3::ZERO);
        let [wide, narrow] = FORMATS.map(|depth_format| {
            let mut sun = Sun::new(&DirectionalShadowDescriptor {
                map_size: 512,
                depth_format,
                layout: CascadeLayout::fixed(1),
                ..Default::default()
            });
            let coverage = Coverage::Bounds(bounds_of(&meshes));
            sun.record(
                DVec3::ZERO,
                shining(world.light),
                coverage,
                &scene.list(),
                &[],
            );
            sun.ask(&points)
        });
        let partial = wide.iter().filter(|seen| **seen > 0.0 && **seen < 1.0);
        assert!(partial.count() > 100, "receivers on edges");
        let pairs = wide.iter().zip(&narrow);
        differences += pairs.filter(|(a, b)| differ(**a, **b, 1e-5)).count();
        asked += points.len();
    }
    assert!(
        differences * 1000 <= asked,
        "{differences} of {asked} on {}",
        gpu().describe()
    );
    table::record(
        "the same scene in maps of 32 and of 16 bits",
        "at most 1 receiver in 1000 answers otherwise, in and around shadows",
        format!("{differences} of {asked}"),
    );
}

/// A scene of a hundred times the usual size lies at the top of ever deeper pits: settled receivers
/// are correct as long as what casts is higher than the reported gap, which is asserted of every
/// box.
#[test]
fn long_depth_ranges_keep_their_shadows() {
    let unit = 100.0;
    let light = DVec3::new(0.05, -1.0, 0.03);
    let world = world(light, any_camera());
    let turn = DMat3::IDENTITY * unit;
    let meshes = meshes(&boxes(), 7.4, turn, DVec3::ZERO);
    let scene = scene(&meshes);
    let mut places = world.floor_around_shadows(2000);
    places.retain(|place| place.abs().max_element() < 5.0);
    let scaled: Vec<_> = places.iter().map(|place| *place * unit).collect();
    let mut all = Verdict::default();
    let mut gaps = Vec::new();
    for depth_format in FORMATS {
        for range in [1e3, 1e4, 1e5] {
            let mut sun = Sun::new(&DirectionalShadowDescriptor {
                map_size: 1024,
                depth_format,
                layout: CascadeLayout::fixed(1),
                ..Default::default()
            });
            let coverage = down_to(range, bounds_of(&meshes));
            let report = sun.record(
                DVec3::ZERO,
                shining(world.light),
                coverage,
                &scene.list(),
                &[],
            );
            let view = &report.views[0];
            assert!(f64::from(view.depth_range_world) >= range);
            let gap = f64::from(view.max_peter_panning_world);
            let lowest = boxes()
                .iter()
                .map(|(_, high)| high.y * unit)
                .fold(f64::INFINITY, f64::min);
            assert!(gap < lowest, "{gap} of {lowest}");
            let seen = sun.ask(&level(&scaled, DVec3::ZERO));
            let verdict = Verdict::of(&world, &places, &seen, sun.texel() / unit, MARGIN);
            verdict.assert_right(&format!("{depth_format:?} over {range}"));
            all.add(&verdict);
            gaps.push(format!("{gap:.2}"));
        }
    }
    table::record(
        "a scene 700 wide in depth ranges of 1e3, 1e4 and 1e5, 32 and 16 bits",
        "settled receivers as the truth says",
        format!("{}; reported gaps {}", all.words(), gaps.join(", ")),
    );
}
