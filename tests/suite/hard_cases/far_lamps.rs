//! Tests spot and point lights far from the world's origin, and in other units.

use glam::{DVec3, Vec3};
use shadow_support::mesh::Mesh;
use shadow_support::probe::Point;
use shadow_support::random::Random;
use wgpu_shadows::{
    Aabb, OmniLight, OmniShadow, OmniShadowDescriptor, ShadowViewUniform, SpotLight, SpotShadow,
    SpotShadowDescriptor,
};

use super::stage::{SUM_ERROR, differ, scene};
use super::table;
use crate::fixtures::ask::{Ask, record_omni, record_spot};
use crate::fixtures::frames::{OmniFrame, SpotFrame};
use crate::fixtures::gpu::gpu;
use crate::fixtures::local_truth::{Settled, settled};
use crate::fixtures::scene::Scene;

const MAP_SIZE: u32 = 256;
/// Is a position that is exact in few bits, so that scaling by powers of two does not round it.
const LIGHT: DVec3 = DVec3::new(0.25, 1.5, -0.5);

/// Returns a room with solids around the light, whose coordinates are whole 64ths times `unit`.
fn room(unit: f64) -> Vec<Mesh> {
    let slab = |x: f64, y: f64, z: f64, half: f64| {
        let (low, high) = (DVec3::new(x, y, z) - half, DVec3::new(x, y, z) + half);
        Mesh::cuboid((low * unit).as_vec3(), (high * unit).as_vec3())
    };
    vec![
        slab(0.0, 0.0, 0.0, 6.0),
        slab(2.5, 0.25, 0.375, 0.625),
        slab(-2.0, 1.75, 2.125, 0.5),
        slab(-1.375, -2.0, -1.25, 0.4375),
        slab(0.375, 4.0, -0.375, 0.5),
        slab(0.25, -1.0, -3.5, 0.75),
    ]
}

/// Holds one point light, and one spot light that shines obliquely down.
struct Both {
    lamp: OmniShadow,
    spot: SpotShadow,
    asks: [Ask; 2],
}

impl Both {
    fn new() -> Self {
        let gpu = gpu();
        let lamp = OmniShadowDescriptor {
            map_size: MAP_SIZE,
            ..Default::default()
        };
        let lamp = OmniShadow::new(&gpu.device, &lamp).expect("a lamp");
        let spot = SpotShadowDescriptor {
            map_size: MAP_SIZE,
            ..Default::default()
        };
        let spot = SpotShadow::new(&gpu.device, &spot).expect("a spot");
        Self {
            asks: [Ask::light(gpu, lamp.maps()), Ask::light(gpu, spot.maps())],
            lamp,
            spot,
        }
    }

    fn record(&mut self, scene: &Scene, origin: DVec3, unit: f64) {
        let position_world = origin + LIGHT * unit;
        let range = (20.0 * unit) as f32;
        let receivers = [Aabb::new(
            Vec3::splat((-8.0 * unit) as f32),
            Vec3::splat((8.0 * unit) as f32),
        )];
        let lamp = OmniFrame {
            origin,
            light: OmniLight {
                position_world,
                range,
            },
            camera: None,
            casters: &scene.list(),
            receivers: &receivers,
        };
        let spot = SpotFrame {
            origin,
            light: SpotLight {
                position_world,
                direction: spot_axis().as_vec3(),
                outer_angle_radians: 0.9,
                range,
            },
            camera: None,
            casters: &scene.list(),
            receivers: &receivers,
        };
        record_omni(gpu(), &mut self.lamp, &lamp).expect("a frame");
        record_spot(gpu(), &mut self.spot, &spot).expect("a frame");
    }

    fn ask(&self, points: &[Point]) -> [Vec<f32>; 2] {
        [0, 1].map(|kind| self.asks[kind].points(gpu(), points))
    }

    fn uniforms(&self) -> Vec<ShadowViewUniform> {
        [
            self.lamp.maps().view_uniforms(),
            self.spot.maps().view_uniforms(),
        ]
        .concat()
    }
}

fn spot_axis() -> DVec3 {
    DVec3::new(0.5, -1.0, 0.25)
}

/// Returns positions all over the room, with normals toward the light, exact in f32 with their
/// unit.
fn points(unit: f64) -> Vec<Point> {
    let mut random = Random::new(109);
    (0..3000)
        .map(|_| {
            let place = random
                .point(DVec3::splat(-5.9), DVec3::splat(5.9))
                .as_vec3()
                .as_dvec3();
            let normal = (LIGHT - place).normalize().as_vec3();
            Point::new((place * unit).as_vec3(), normal)
        })
        .collect()
}

/// Positions in f64 relative to the origin are exact where the coordinates are, so all bits are the
/// same.
#[test]
fn local_lights_far_away_are_the_same_to_the_bit() {
    let scene = scene(&room(1.0));
    let points = points(1.0);
    let mut near = Both::new();
    near.record(&scene, DVec3::ZERO, 1.0);
    let (seen, uniforms) = (near.ask(&points), near.uniforms());
    for seen in &seen {
        let dark = seen.iter().filter(|seen| **seen == 0.0).count();
        assert!(dark > 50 && dark < 2000, "{dark} dark");
    }
    let mut compared = 0;
    for exponent in [10, 13, 17, 20, 23, 24] {
        let away = f64::from(exponent).exp2();
        for origin in [DVec3::splat(away), DVec3::new(-away, 3.0, 2.0 * away)] {
            let mut far = Both::new();
            far.record(&scene, origin, 1.0);
            assert_eq!(
                bytemuck::cast_slice::<_, u8>(&uniforms),
                bytemuck::cast_slice::<_, u8>(&far.uniforms()),
                "{origin}"
            );
            for (a, b) in seen.iter().zip(&far.ask(&points)) {
                assert!(
                    a.iter().zip(b).all(|(a, b)| a.to_bits() == b.to_bits()),
                    "{origin}"
                );
                compared += a.len();
            }
        }
    }
    table::record(
        "spot and point lights 2^10 to 2^25 away with an origin",
        "bit-identical to the same at zero",
        format!("0 bits differ in {compared} visibilities"),
    );
}

/// In units that are powers of two no bit of a visibility changes; in others settled receivers are
/// correct. The same holds at any distance with an origin.
#[test]
fn local_lights_know_no_unit() {
    let points_of = points;
    let mut one = Both::new();
    one.record(&scene(&room(1.0)), DVec3::ZERO, 1.0);
    let seen = one.ask(&points_of(1.0));
    let mut compared = 0;
    for exponent in [-20, -10, -3, 3, 10, 20] {
        let unit = f64::from(exponent).exp2();
        let mut other = Both::new();
        other.record(&scene(&room(unit)), DVec3::ZERO, unit);
        for (a, b) in seen.iter().zip(&other.ask(&points_of(unit))) {
            let same = a.iter().zip(b).all(|(a, b)| a.to_bits() == b.to_bits());
            assert!(same, "unit 2^{exponent} on {}", gpu().describe());
            compared += a.len();
        }
    }
    table::record(
        "spot and point lights in units of 2^-20 to 2^20",
        "bit-identical",
        format!("0 bits differ in {compared} visibilities"),
    );
}

/// Returns, as a tangent, the reach, half a texel of stairs and the residual offset, toward a
/// face's corner along both axes at once.
fn tangent() -> f64 {
    3.5 * 2.0_f64.sqrt() * 1.05 * 2.0 / f64::from(MAP_SIZE)
}

#[test]
fn local_lights_anywhere_are_as_the_truth_says() {
    let (mut wrong, mut dark, mut lit) = (0, 0, 0);
    let places = [1e-3, 0.3048, 1.0, 3.0, 1e3, 1e6]
        .map(|unit| (unit, 0.0))
        .into_iter()
        .chain([1e3, 1e5, 1e6, 1e7].map(|away| (1.0, away)));
    for (unit, away) in places {
        let scene = scene(&room(unit));
        let mut both = Both::new();
        both.record(&scene, DVec3::new(1.0, -0.3, 0.77) * away, unit);
        let mut random = Random::new(113);
        let light = LIGHT * unit;
        let axis = spot_axis();
        let everywhere: &dyn Fn(DVec3) -> bool = &|_| true;
        let in_cone: &dyn Fn(DVec3) -> bool = &|place| (place - light).angle_between(axis) < 0.88;
        for (kind, wanted, wider) in [(0, everywhere, 1.0), (1, in_cone, 1.3 / 0.62)] {
            let triangles = &scene.triangles;
            let truth: Settled = settled(
                triangles,
                light,
                tangent() * wider,
                4000,
                &mut random,
                wanted,
            );
            let seen = both.asks[kind].points(gpu(), &truth.points);
            for (is_dark, seen) in truth.dark.iter().zip(&seen) {
                wrong += usize::from(differ(*seen, if *is_dark { 0.0 } else { 1.0 }, SUM_ERROR));
                dark += usize::from(*is_dark);
                lit += usize::from(!is_dark);
            }
        }
    }
    assert_eq!(
        wrong,
        0,
        "of {dark} dark and {lit} lit on {}",
        gpu().describe()
    );
    assert!(dark > 1000 && lit > 10_000, "{dark} dark, {lit} lit");
    table::record(
        "spot and point lights in units of 1e-3 to 1e6, and 1e3 to 1e7 away with an origin",
        "settled receivers as the truth says",
        format!(
            "{wrong} wrong of {} settled receivers, {dark} of them dark",
            dark + lit
        ),
    );
}
