//! Tests spot lights: cones from a thread to nearly a half space have no acne, are dark up to the
//! rim and lit beyond it, and their shadows are where a ray caster has them.

use std::f64::consts::{PI, TAU};

use glam::{DVec3, Vec3};
use shadow_support::mesh::Mesh;
use shadow_support::probe::Point;
use shadow_support::random::Random;
use wgpu_shadows::{Aabb, Bias, Filter, SpotLight, SpotShadow, SpotShadowDescriptor};

use crate::fixtures::ask::{Ask, record_spot};
use crate::fixtures::frames::SpotFrame;
use crate::fixtures::gpu::{Gpu, gpu};
use crate::fixtures::local_truth::settled;
use crate::fixtures::rounding::U;
use crate::fixtures::scene::Scene;
use crate::fixtures::table;

const EVERYWHERE: [Aabb; 1] = [Aabb::new(Vec3::splat(-60.0), Vec3::splat(60.0))];

/// Are the angles that a cone spans, from rim to rim.
const CONES_DEGREES: [f64; 11] = [
    0.1, 1.0, 10.0, 45.0, 90.0, 120.0, 150.0, 170.0, 178.0, 179.0, 179.9,
];

struct Spot {
    shadow: SpotShadow,
    ask: Ask,
    name: String,
}

impl Spot {
    fn new(gpu: &Gpu, map_size: u32, filter: Filter, bias: Bias) -> Self {
        let descriptor = SpotShadowDescriptor {
            map_size,
            filter,
            bias,
            ..Default::default()
        };
        let shadow = SpotShadow::new(&gpu.device, &descriptor).expect("a valid spot");
        Self {
            ask: Ask::light(gpu, shadow.maps()),
            shadow,
            name: format!("{filter:?} {bias:?} map {map_size}"),
        }
    }

    fn record(&mut self, gpu: &Gpu, scene: &Scene, light: SpotLight) {
        let frame = SpotFrame {
            origin: DVec3::ZERO,
            light,
            camera: None,
            casters: &scene.list(),
            receivers: &EVERYWHERE,
        };
        let report = record_spot(gpu, &mut self.shadow, &frame).expect("a valid frame");
        assert_eq!(report.passes, 1, "{light:?}");
    }
}

fn light(position_world: DVec3, direction: DVec3, cone_degrees: f64, range: f32) -> SpotLight {
    SpotLight {
        position_world,
        direction: direction.as_vec3(),
        outer_angle_radians: (cone_degrees * 0.5).to_radians() as f32,
        range,
    }
}

/// Returns a direction at the fraction `share` of the way from the axis to the rim, rotated around
/// the axis; the rim is the light's own, in f32.
fn in_cone(light: &SpotLight, share: f64, turn: f64) -> DVec3 {
    let axis = light.direction.as_dvec3().normalize();
    let side = axis.any_orthonormal_vector();
    let aside = side * turn.cos() + axis.cross(side) * turn.sin();
    let angle = f64::from(light.outer_angle_radians) * share;
    axis * angle.cos() + aside * angle.sin()
}

/// Returns a leaning plane under the light, and receivers on it all over the cone, out to nearly
/// the end of the range.
fn plane_under(light: &SpotLight, tilt: f64, random: &mut Random) -> (Mesh, Vec<Point>) {
    let axis = light.direction.as_dvec3().normalize();
    let side = axis.any_orthonormal_vector();
    let lean = side.rotate_axis(axis, random.range(0.0, TAU));
    let normal = (-axis * tilt.cos() + lean * tilt.sin()).normalize();
    let through = light.position_world + axis * 4.0;
    let u = normal.any_orthonormal_vector();
    let v = normal.cross(u);
    let sheet = Mesh::sheet(
        (through - (u + v) * 50.0).as_vec3(),
        (u * 100.0).as_vec3(),
        (v * 100.0).as_vec3(),
    );
    // This is the plane through the rounded corners.
    let triangle = sheet.triangles(&glam::Mat4::IDENTITY)[0];
    let (through, normal) = (triangle.0[0], triangle.normal());
    let mut points = Vec::new();
    for _ in 0..3000 {
        let direction = in_cone(light, random.unit().sqrt(), random.range(0.0, TAU));
        let t = normal.dot(through - light.position_world) / normal.dot(direction);
        if t > 0.0 && t < 0.99 * f64::from(light.range) {
            let lit_side = -normal.dot(direction).signum();
            points.push(Point::rounded(
                light.position_world + direction * t,
                normal * lit_side,
            ));
        }
    }
    (sheet, points)
}

#[test]
fn planes_under_any_cone_are_lit() {
    let asked = assert_planes_lit(&CONES_DEGREES[..8]);
    table::record(
        "planes under spot cones of 0.1 to 170 degrees, leaning up to 85 degrees",
        "no receiver darker than lit less 1/255",
        format!("0 of {asked} receivers"),
    );
}

/// One map covers nearly a half space: its texels are wider than the distance to what they see.
#[test]
fn planes_under_the_widest_cones_are_lit() {
    let asked = assert_planes_lit(&CONES_DEGREES[8..]);
    table::record(
        "planes under spot cones of 178 to 179.9 degrees, leaning up to 85 degrees",
        "no receiver darker than lit less 1/255",
        format!("0 of {asked} receivers"),
    );
}

/// Returns how many receivers were sampled.
fn assert_planes_lit(cones_degrees: &[f64]) -> usize {
    let gpu = gpu();
    let (mut failures, mut asked) = (Vec::new(), 0);
    for (filter, bias) in [
        (Filter::default(), Bias::Auto),
        (Filter::Tent7 { sharpness: 1.0 }, Bias::Auto),
        (Filter::Bilinear { sharpness: 1.0 }, Bias::NormalOffset),
        (Filter::Box, Bias::NormalOffset),
        (Filter::Hardware, Bias::Auto),
    ] {
        let mut spot = Spot::new(gpu, 300, filter, bias);
        let mut random = Random::new(61);
        for &cone in cones_degrees {
            for tilt_degrees in [0.0, 20.0, 60.0, 85.0_f64] {
                let light = light(
                    DVec3::new(0.3, 5.0, -0.7),
                    DVec3::new(0.2, -1.0, 0.1),
                    cone,
                    40.0,
                );
                let tilt = tilt_degrees.to_radians();
                let (sheet, points) = plane_under(&light, tilt, &mut random);
                assert!(
                    points.len() > 300,
                    "{cone} {tilt_degrees}: {}",
                    points.len()
                );
                spot.record(gpu, &Scene::new(gpu, &[sheet]), light);
                let seen = spot.ask.points(gpu, &points);
                asked += seen.len();
                let dark = seen
                    .iter()
                    .filter(|seen| **seen < 1.0 - 1.0 / 255.0)
                    .count();
                if dark > 0 {
                    let darkest = seen.iter().copied().fold(1.0, f32::min);
                    failures.push(format!(
                        "{} cone {cone} tilt {tilt_degrees}: {dark} of {} in shadow, down to {darkest}",
                        spot.name,
                        points.len()
                    ));
                }
            }
        }
    }
    assert!(
        failures.is_empty(),
        "{}\n{}",
        gpu.describe(),
        failures.join("\n")
    );
    asked
}

/// Without a bias the same planes shadow themselves, so the test above would notice it.
#[test]
fn planes_would_shadow_themselves() {
    let gpu = gpu();
    let none = Bias::Manual {
        constant: 0.0,
        slope: 0.0,
    };
    let mut spot = Spot::new(gpu, 300, Filter::Bilinear { sharpness: 1.0 }, none);
    let mut random = Random::new(61);
    // OpenGL clips depths to -1..1. What is allowed for the clipping of a plane 100 wide is more
    // than a texel of the narrowest cones comes to.
    let is_gl = gpu.adapter.backend == wgpu::Backend::Gl;
    let cones = CONES_DEGREES.into_iter();
    for cone in cones.filter(|cone| *cone >= 10.0 || !is_gl) {
        let light = light(DVec3::new(0.3, 5.0, -0.7), DVec3::NEG_Y, cone, 40.0);
        let (sheet, points) = plane_under(&light, 1.0, &mut random);
        spot.record(gpu, &Scene::new(gpu, &[sheet]), light);
        let seen = spot.ask.points(gpu, &points);
        let dark = seen.iter().filter(|seen| **seen < 0.99).count();
        assert!(
            dark > points.len() / 4,
            "{cone}: {dark} of {}",
            points.len()
        );
    }
}

/// Under a plate that covers the whole cone everything is dark up to the rim, and lit from the rim
/// on.
#[test]
fn the_cone_ends_at_its_rim() {
    let gpu = gpu();
    for filter in [Filter::default(), Filter::Tent7 { sharpness: 1.0 }] {
        let mut spot = Spot::new(gpu, 128, filter, Bias::Auto);
        // The rim of 179.9 degrees lies within 1/1024 of the reach of the light's own plane, where
        // nothing casts.
        for cone in CONES_DEGREES.into_iter().filter(|cone| *cone < 179.5) {
            let direction = DVec3::new(0.3, -1.0, 0.2);
            let light = light(DVec3::new(0.5, 2.0, -0.25), direction, cone, 30.0);
            let axis = direction.normalize();
            let normal = -axis;
            let u = normal.any_orthonormal_vector();
            let v = normal.cross(u);
            // There are occluders on all sides, closer than the receivers.
            let dome = Mesh::sphere(light.position_world.as_vec3(), 5.0, 24);
            let plate = Mesh::sheet(
                (light.position_world + axis - (u + v) * 2.0).as_vec3(),
                (u * 4.0).as_vec3(),
                (v * 4.0).as_vec3(),
            );
            spot.record(gpu, &Scene::new(gpu, &[dome, plate]), light);
            // The rim is found by a cosine that is rounded a few times: 8u of cosine are 8u / sin
            // of angle.
            let angle = f64::from(light.outer_angle_radians);
            let slack = 1e-5 + 8.0 * U / angle.sin() / angle;
            let at = |share: f64| -> Vec<Point> {
                (0..100)
                    .map(|step| {
                        let direction = in_cone(&light, share, f64::from(step) * TAU / 100.0);
                        Point::rounded(light.position_world + direction * 8.0, -direction)
                    })
                    .collect()
            };
            for share in [0.0, 0.5, 1.0 - slack] {
                if share > 1.0 - slack {
                    continue;
                }
                let seen = spot.ask.points(gpu, &at(share));
                let lit = seen.iter().filter(|seen| **seen > 1e-5).count();
                assert_eq!(
                    lit, 0,
                    "{} cone {cone}: {lit} of 100 lit at {share}",
                    spot.name
                );
            }
            for share in [1.0 + slack, 1.0 + 2.0 * slack, 1.2, PI / angle] {
                let seen = spot.ask.points(gpu, &at(share));
                let dark = seen.iter().filter(|seen| **seen != 1.0).count();
                assert_eq!(
                    dark, 0,
                    "{} cone {cone}: {dark} of 100 dark at {share}",
                    spot.name
                );
            }
        }
    }
    table::record(
        "the rim of spot cones of 0.1 to 179 degrees, all occluded",
        "dark up to the rim and lit beyond, within the rounding of a cosine",
        "as expected",
    );
}

#[test]
fn shadows_are_where_rays_have_them() {
    let gpu = gpu();
    let slab = |center: Vec3, half: f32| Mesh::cuboid(center - half, center + Vec3::splat(half));
    let scene = Scene::new(
        gpu,
        &[
            Mesh::floor(0.0, 8.0),
            slab(Vec3::new(0.9, 1.5, 0.2), 0.5),
            slab(Vec3::new(-1.1, 0.6, -0.9), 0.4),
            Mesh::sphere(Vec3::new(-0.4, 2.0, 1.2), 0.6, 12),
        ],
    );
    const MAP: u32 = 400;
    let mut random = Random::new(67);
    for (filter, bias) in [
        (Filter::default(), Bias::Auto),
        (Filter::Tent7 { sharpness: 1.0 }, Bias::Auto),
        (Filter::Hardware, Bias::Auto),
    ] {
        let mut spot = Spot::new(gpu, MAP, filter, bias);
        for cone in [30.0, 70.0, 110.0] {
            let light = light(
                DVec3::new(0.6, 6.0, -1.1),
                DVec3::new(-0.1, -1.0, 0.2),
                cone,
                20.0,
            );
            spot.record(gpu, &scene, light);
            let angle = f64::from(light.outer_angle_radians);
            // A map covers no more than the cone's square; toward a corner both axes count.
            let texel = 2.0 * angle.tan() / f64::from(MAP) * 1.05;
            let tangent = (filter.reach_texels() + 1.5) * 2.0_f64.sqrt() * texel;
            let axis = light.direction.as_dvec3().normalize();
            let inside = |place: DVec3| {
                (place - light.position_world)
                    .normalize()
                    .angle_between(axis)
                    < 0.99 * angle
            };
            let truth = settled(
                &scene.triangles,
                light.position_world,
                tangent,
                8000,
                &mut random,
                inside,
            );
            let [dark, lit] = truth.counts();
            assert!(
                dark > 40 && lit > 300,
                "cone {cone}: {dark} dark, {lit} lit"
            );
            let seen = spot.ask.points(gpu, &truth.points);
            truth.assert_agrees(&seen, &format!("{} cone {cone}", spot.name));
        }
    }
}
