//! Tests casters above casters: light that one of them blocks stays blocked.

use glam::{DVec3, Vec3};
use shadow_support::mesh::Mesh;
use shadow_support::probe::Point;
use shadow_support::random::Random;
use wgpu_shadows::{Aabb, Bias, CascadeLayout, DirectionalShadowDescriptor, Filter};

use super::stage::{SUM_ERROR, Sun, scene, shining};
use super::table;
use crate::fixtures::frames::Coverage;
use crate::fixtures::gpu::gpu;

/// A roof lies over a shelf over a floor, with a deep pit below: the floor and the shelf are dark
/// to the last bit under every filter and derived bias, however thin roof and shelf are and however
/// close to each other, as long as the receiver lies deeper below the roof than the reported gap.
/// The roof's own top is lit.
#[test]
fn nothing_leaks_through_a_stack() {
    let mut asked = 0;
    let mut random = Random::new(13);
    for filter in Filter::PLANAR.iter().copied().chain([Filter::default()]) {
        for bias in [Bias::Auto, Bias::NormalOffset] {
            let mut sun = Sun::new(&DirectionalShadowDescriptor {
                map_size: 256,
                filter,
                bias,
                layout: CascadeLayout::fixed(1),
                ..Default::default()
            });
            for light in [
                DVec3::NEG_Y,
                DVec3::new(0.4, -1.0, 0.3),
                DVec3::new(-1.0, -1.0, 0.2),
            ] {
                for (gap, pit) in [(1e-3, 1.0), (0.05, 100.0), (0.5, 1.0), (3.0, 1e4)] {
                    let shelf = 1.0_f64;
                    let roof = shelf + gap;
                    let sheet = |y: f64| Mesh::floor(y as f32, 12.0);
                    let scene = scene(&[sheet(roof), sheet(shelf), sheet(0.0)]);
                    let cover = Aabb::new(
                        Vec3::new(-3.0, -pit as f32, -3.0),
                        Vec3::new(3.0, roof as f32, 3.0),
                    );
                    // Slanted light reaches far sideways in a deep pit: there the map is as wide as
                    // the pit is deep.
                    if light.x != 0.0 && pit > 100.0 {
                        continue;
                    }
                    let report = sun.record(
                        DVec3::ZERO,
                        shining(light),
                        Coverage::Bounds(cover),
                        &scene.list(),
                        &[],
                    );
                    let worst = f64::from(report.views[0].max_peter_panning_world);
                    let mut heights = vec![0.0_f64];
                    if gap > worst {
                        heights.push(shelf);
                    }
                    for height in heights {
                        if roof - height <= worst {
                            continue;
                        }
                        let low = DVec3::new(-2.5, height, -2.5);
                        let high = DVec3::new(2.5, height, 2.5);
                        let points: Vec<_> = (0..400)
                            .map(|_| Point::rounded(random.point(low, high), DVec3::Y))
                            .collect();
                        asked += points.len();
                        let brightest = sun.ask(&points).into_iter().fold(0.0, f32::max);
                        assert!(
                            brightest <= SUM_ERROR,
                            "{filter:?} {bias:?} light {light} gap {gap} pit {pit} at {height} on {}: {brightest}",
                            gpu().describe()
                        );
                    }
                    let top: Vec<_> = (0..100)
                        .map(|_| {
                            let low = DVec3::new(-2.5, roof, -2.5);
                            let place = random.point(low, DVec3::new(2.5, roof, 2.5));
                            Point::rounded(place, DVec3::Y)
                        })
                        .collect();
                    let darkest = sun.ask(&top).into_iter().fold(1.0, f32::min);
                    assert!(darkest >= 1.0 - 1.0 / 255.0, "{filter:?} {bias:?} {light}");
                }
            }
        }
    }
    assert!(asked > 20_000, "{asked}");
    table::record(
        "two occluders over a receiver",
        "no light below them, under every filter and derived bias",
        format!("0 of {asked} receivers"),
    );
}
