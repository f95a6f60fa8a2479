//! Tests spot and point lights very close above a surface: it stays lit, and what is on it casts.

use glam::{DVec3, Vec3};
use shadow_support::mesh::Mesh;
use shadow_support::probe::Point;
use shadow_support::random::Random;
use wgpu_shadows::{
    Aabb, Bias, Filter, OmniLight, OmniShadow, OmniShadowDescriptor, SpotLight, SpotShadow,
    SpotShadowDescriptor,
};

use super::stage::scene;
use super::table;
use crate::fixtures::ask::{Ask, record_omni, record_spot};
use crate::fixtures::frames::{OmniFrame, SpotFrame};
use crate::fixtures::gpu::gpu;

const RANGE: f64 = 10.0;
const EVERYWHERE: [Aabb; 1] = [Aabb::new(Vec3::splat(-30.0), Vec3::splat(30.0))];

/// Holds a point light and a spot light under one filter and bias.
struct Both {
    lamp: OmniShadow,
    spot: SpotShadow,
    asks: [Ask; 2],
}

impl Both {
    fn new(filter: Filter, bias: Bias) -> Self {
        let (gpu, map_size) = (gpu(), 256);
        let descriptor = OmniShadowDescriptor {
            map_size,
            filter,
            bias,
            ..Default::default()
        };
        let lamp = OmniShadow::new(&gpu.device, &descriptor).expect("a lamp");
        let descriptor = SpotShadowDescriptor {
            map_size,
            filter,
            bias,
            ..Default::default()
        };
        let spot = SpotShadow::new(&gpu.device, &descriptor).expect("a spot");
        Self {
            asks: [Ask::light(gpu, lamp.maps()), Ask::light(gpu, spot.maps())],
            lamp,
            spot,
        }
    }

    /// Returns the visibilities of the point light, and of the spot light that shines along the
    /// floor and a little down.
    fn look(&mut self, meshes: &[Mesh], light: DVec3, points: &[Point]) -> [Vec<f32>; 2] {
        let gpu = gpu();
        let scene = scene(meshes);
        let casters = &scene.list()[..];
        let lamp = OmniFrame {
            origin: DVec3::ZERO,
            light: OmniLight {
                position_world: light,
                range: RANGE as f32,
            },
            camera: None,
            casters,
            receivers: &EVERYWHERE,
        };
        let spot = SpotFrame {
            origin: DVec3::ZERO,
            light: SpotLight {
                position_world: light,
                direction: Vec3::new(1.0, -0.2, 0.1),
                outer_angle_radians: 1.2,
                range: RANGE as f32,
            },
            camera: None,
            casters,
            receivers: &EVERYWHERE,
        };
        record_omni(gpu, &mut self.lamp, &lamp).expect("a frame");
        record_spot(gpu, &mut self.spot, &spot).expect("a frame");
        [0, 1].map(|kind| self.asks[kind].points(gpu, points))
    }
}

/// Is a step of 8 bits.
const STEP: f32 = 1.0 / 255.0;

/// Are heights above the floor as fractions of the range. From the lowest, light reaches the
/// floor's far end at 0.006 degrees.
const HEIGHTS: [f64; 4] = [1e-4, 1e-3, 1e-2, 0.1];

/// The floor, which is in the maps, is lit everywhere, from under the light to the end of its
/// range: the only tolerance is a step of 8 bits, by the derivation of the bias. A wall at half the
/// range is lit on the light's side, farther above the floor than the kernels reach, and what is
/// behind it is dark.
#[test]
fn lights_almost_on_a_surface() {
    let floor = Mesh::floor(0.0, 12.0);
    let wall = Mesh::cuboid(Vec3::new(5.0, -0.1, -3.0), Vec3::new(5.2, 2.0, 3.0));
    let mut random = Random::new(97);
    let mut on_floor = Vec::new();
    let mut behind = Vec::new();
    for _ in 0..2000 {
        let angle = random.range(0.0, std::f64::consts::TAU);
        // There are as many receivers near the foot as far from it.
        let away = RANGE * 10_f64.powf(random.range(-5.0, -0.01));
        let place = DVec3::new(angle.cos(), 0.0, angle.sin()) * away;
        on_floor.push(Point::rounded(place, DVec3::Y));
        // The position is behind the wall as seen from the light, well inside its outline.
        let place = random.point(DVec3::new(8.0, 0.5, -2.0), DVec3::new(8.0, 1.6, 2.0));
        behind.push(Point::rounded(place, DVec3::NEG_X));
    }
    let up_the_wall: Vec<_> = (0..500)
        .map(|_| {
            let place = random.point(DVec3::new(5.0, 1.0, -2.5), DVec3::new(5.0, 1.8, 2.5));
            Point::rounded(place, DVec3::NEG_X)
        })
        .collect();
    let (mut failures, mut asked) = (Vec::new(), 0);
    for filter in Filter::PLANAR.iter().copied().chain([Filter::default()]) {
        for bias in [Bias::Auto, Bias::NormalOffset] {
            let mut both = Both::new(filter, bias);
            for height in HEIGHTS {
                let light = DVec3::new(0.0, RANGE * height, 0.0);
                let mut check = |what: &str, meshes: &[Mesh], points: &[Point], dark: bool| {
                    asked += 2 * points.len();
                    for (kind, seen) in ["lamp", "spot"]
                        .into_iter()
                        .zip(both.look(meshes, light, points))
                    {
                        let right = if dark { 0.0..=STEP } else { 1.0 - STEP..=1.0 };
                        let wrong = |seen: &&f32| !right.contains(*seen);
                        let count = seen.iter().filter(wrong).count();
                        if count > 0 {
                            let range = seen
                                .iter()
                                .fold((1.0_f32, 0.0_f32), |(a, b), s| (a.min(*s), b.max(*s)));
                            failures.push(format!("{kind} {filter:?} {bias:?} height {height} {what}: {count} of {}, {range:?}", seen.len()));
                        }
                    }
                };
                check("floor", std::slice::from_ref(&floor), &on_floor, false);
                let all = [floor.clone(), wall.clone()];
                check("wall", &all, &up_the_wall, false);
                check("behind the wall", &all, &behind, true);
            }
        }
    }
    assert!(
        failures.is_empty(),
        "{}: {}\n{}",
        gpu().describe(),
        failures.len(),
        failures.join("\n")
    );
    table::record(
        "spot and point lights 1e-4 to 0.1 of their range above a floor",
        "the floor lit all over, a wall on it lit, what stands behind it dark, under every filter and derived bias",
        format!("0 wrong of {asked} receivers"),
    );
}
