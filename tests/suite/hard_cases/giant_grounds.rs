//! Grounds of two triangles that end a thousand kilometres away, under a lamp at 3 m: they do not
//! shadow themselves.

use std::f64::consts::TAU;

use glam::{DMat3, DVec3, EulerRot, Vec3};
use shadow_support::mesh::Mesh;
use shadow_support::probe::Point;
use shadow_support::random::Random;
use shadow_support::triangle::Triangle;
use wgpu_shadows::{
    Aabb, Bias, Filter, OmniLight, OmniShadow, OmniShadowDescriptor, SpotLight, SpotShadow,
    SpotShadowDescriptor,
};

use super::stage::scene;
use super::table;
use crate::fixtures::ask::{Ask, record_omni, record_spot};
use crate::fixtures::frames::{OmniFrame, SpotFrame};
use crate::fixtures::gpu::gpu;

/// Half sides of the grounds.
const GROUNDS: [f64; 6] = [30.0, 1e2, 1e3, 1e4, 1e5, 1e6];

/// Up to this distance from the lamp's foot the ground is looked at.
const NEAR: f64 = 20.0;

/// Positions on the ground's own triangles, which rounding has tilted a little, with the normal of
/// the lit side.
fn points_on(triangles: &[Triangle], turn: DMat3, random: &mut Random) -> Vec<Point> {
    let mut points = Vec::new();
    for _ in 0..3000 {
        let (angle, away) = (random.range(0.0, TAU), NEAR * random.unit());
        let above = turn * DVec3::new(angle.cos() * away, 1.0, angle.sin() * away);
        let down = turn * DVec3::NEG_Y;
        let hit = triangles
            .iter()
            .find_map(|triangle| triangle.hit(above, down).map(|t| (t, triangle)));
        if let Some((t, triangle)) = hit {
            let normal = triangle.normal() * -triangle.normal().dot(down).signum();
            points.push(Point::rounded(above + down * t, normal));
        }
    }
    points
}

/// Corners are rounded by 2^-24 of their coordinates, and so is where a triangle is clipped at the
/// sides of a map: the triangle is displaced by as much next to the lamp, 6 cm at a thousand
/// kilometres. A box stands in the ground, so that the ground is among the casters.
#[test]
fn grounds_of_two_triangles_do_not_shadow_themselves() {
    let gpu = gpu();
    let everywhere = [Aabb::new(Vec3::splat(-60.0), Vec3::splat(60.0))];
    let turns = [
        DMat3::IDENTITY,
        DMat3::from_rotation_y(0.7),
        DMat3::from_euler(EulerRot::XYZ, 0.3, 0.5, -0.4),
        DMat3::from_euler(EulerRot::XYZ, 1.0, 2.5, 0.6),
    ];
    let mut random = Random::new(5);
    let (mut failures, mut sampled) = (Vec::new(), 0);
    for (filter, bias) in [
        (Filter::default(), Bias::Auto),
        (Filter::Tent7 { sharpness: 1.0 }, Bias::Auto),
        (Filter::Bilinear { sharpness: 1.0 }, Bias::NormalOffset),
        (Filter::Hardware, Bias::Auto),
    ] {
        let lamp = OmniShadowDescriptor {
            filter,
            bias,
            ..Default::default()
        };
        let mut lamp = OmniShadow::new(&gpu.device, &lamp).expect("a lamp");
        let spot = SpotShadowDescriptor {
            filter,
            bias,
            ..Default::default()
        };
        let mut spot = SpotShadow::new(&gpu.device, &spot).expect("a spot");
        let asks = [Ask::light(gpu, lamp.maps()), Ask::light(gpu, spot.maps())];
        for half in GROUNDS {
            for (turn, shift) in turns.iter().flat_map(|turn| [(*turn, 0.0), (*turn, 0.37)]) {
                let at = |position: DVec3| (turn * position).as_vec3();
                let ground = Mesh::sheet(
                    at(DVec3::new(-half, 0.0, -half * (1.0 + shift))),
                    at(DVec3::Z * (2.0 * half)),
                    at(DVec3::X * (2.0 * half)),
                );
                let mut post = Mesh::cuboid(Vec3::new(40.0, -1.0, 0.0), Vec3::new(41.0, 0.5, 1.0));
                for position in &mut post.positions {
                    *position = at(position.as_dvec3());
                }
                let scene = scene(&[ground, post]);
                let points = points_on(&scene.triangles[..2], turn, &mut random);
                let position_world = turn * DVec3::new(0.3, 3.0, -0.2);
                let (casters, receivers) = (&scene.list()[..], &everywhere);
                // How far the light shines makes no difference.
                let range = if shift == 0.0 { 60.0 } else { f32::INFINITY };
                let frame = OmniFrame {
                    origin: DVec3::ZERO,
                    light: OmniLight {
                        position_world,
                        range,
                    },
                    camera: None,
                    casters,
                    receivers,
                };
                record_omni(gpu, &mut lamp, &frame).expect("a frame");
                let frame = SpotFrame {
                    origin: DVec3::ZERO,
                    light: SpotLight {
                        position_world,
                        direction: at(DVec3::new(0.6, -1.0, 0.25)),
                        outer_angle_radians: 1.2,
                        range,
                    },
                    camera: None,
                    casters,
                    receivers,
                };
                record_spot(gpu, &mut spot, &frame).expect("a frame");
                for (kind, ask) in ["lamp", "spot"].into_iter().zip(&asks) {
                    let seen = ask.points(gpu, &points);
                    sampled += seen.len();
                    let lit = 1.0 - 1.0 / 255.0;
                    let dark = seen.iter().filter(|seen| **seen < lit).count();
                    if dark > 0 {
                        failures.push(format!(
                            "{kind} {filter:?} {bias:?}, half side {half}, turned by {turn}, shifted by {shift}: {dark} of {}",
                            seen.len()
                        ));
                    }
                }
            }
        }
    }
    assert!(
        failures.is_empty(),
        "{}: {}\n{}",
        gpu.describe(),
        failures.len(),
        failures.join("\n")
    );
    table::record(
        "grounds of two triangles, half side 30 to 1e6, under spot and point lights at 3",
        "no receiver darker than lit less 1/255",
        format!("0 of {sampled} receivers"),
    );
}
