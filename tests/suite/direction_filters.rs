//! Tests the direction-space filters of point lights on the device against a reference in f64 that
//! is written here from their description: 64 or 20 nearest comparisons in the faces read back,
//! along the receiver's direction plus an offset.
//!
//! A single comparison is undecided where f32 does not resolve it. The reference evaluates the
//! receiver and the corners of its rounding band, on every face on which the sample may lie, and
//! the device's mean must lie between the means of the least and of the greatest results.

use glam::{DVec2, DVec3, Vec3};
use shadow_support::camera::Camera;
use shadow_support::mesh::Mesh;
use shadow_support::probe::Point;
use shadow_support::random::Random;
use shadow_support::readback;
use wgpu_shadows::reference::{self, DepthLayer, Receiver};
use wgpu_shadows::{
    Aabb, Bias, Filter, OmniLight, OmniShadow, OmniShadowDescriptor, ShadowViewUniform,
};

use crate::fixtures::ask::{Ask, record_omni};
use crate::fixtures::frames::OmniFrame;
use crate::fixtures::gpu::gpu;
use crate::fixtures::rounding::{Band, U, band};
use crate::fixtures::scene::Scene;
use crate::fixtures::view_member::member;

const MAP_SIZE: u32 = 120;
const LIGHT: DVec3 = DVec3::new(0.25, 0.5, -0.125);
/// Is less than the distance to the farthest corner, so that it is the light's reach.
const RANGE: f32 = 9.0;

/// Returns four by four by four points in a cube of half side 1.
fn grid() -> Vec<DVec3> {
    let steps = [-0.75, -0.25, 0.25, 0.75];
    let mut offsets = Vec::new();
    for x in steps {
        for y in steps {
            for z in steps {
                offsets.push(DVec3::new(x, y, z));
            }
        }
    }
    offsets
}

/// Returns the corners of a cube and the middles of its edges.
fn star() -> Vec<DVec3> {
    let mut offsets = Vec::new();
    for x in -1..=1 {
        for y in -1..=1 {
            for z in -1..=1_i32 {
                if x * x + y * y + z * z >= 2 {
                    offsets.push(DVec3::new(f64::from(x), f64::from(y), f64::from(z)));
                }
            }
        }
    }
    offsets
}

struct Reference {
    uniforms: Vec<ShadowViewUniform>,
    faces: Vec<Vec<f32>>,
    filter: Filter,
    bias: Bias,
    eye: Option<DVec3>,
}

impl Reference {
    /// Returns the faces on which a position may lie, as far as f32 resolves it: that of the
    /// largest component, and those of components nearly equal to it.
    fn faces(from_light: DVec3) -> impl Iterator<Item = usize> {
        let reach = from_light.abs();
        (0..3)
            .filter(move |axis| reach[*axis] >= reach.max_element() * (1.0 - 64.0 * U))
            .map(move |axis| 2 * axis + usize::from(from_light[axis] < 0.0))
    }

    /// Returns the means of the least and of the greatest results of the samples.
    fn range(&self, position: DVec3, normal: DVec3) -> (f64, f64) {
        let from_light = position - LIGHT;
        let (offsets, radius) = match self.filter {
            Filter::DirectionGrid { radius } => (grid(), radius),
            Filter::DirectionStar { radius } => (star(), radius),
            _ => unreachable!("only these two look along directions"),
        };
        let share = self.eye.map_or(0.0, |eye| eye.distance(position));
        let radius = f64::from(radius) * (1.0 + share / f64::from(RANGE));
        let mut sum = (0.0, 0.0);
        for offset in &offsets {
            let direction = (from_light + *offset * radius).normalize();
            let reach = from_light.length();
            let place = if self.bias == Bias::Auto {
                let hit = normal.dot(from_light) / normal.dot(direction);
                direction * if hit > 0.0 { hit.min(reach) } else { reach }
            } else {
                direction * reach
            };
            let (low, high) = self.sample(place, normal);
            sum = (sum.0 + low, sum.1 + high);
        }
        let count = offsets.len() as f64;
        (sum.0 / count, sum.1 / count)
    }

    fn sample(&self, place: DVec3, normal: DVec3) -> (f64, f64) {
        let mut range = (f64::INFINITY, f64::NEG_INFINITY);
        for face in Self::faces(place) {
            let uniform = &self.uniforms[face];
            let map = DepthLayer {
                size: MAP_SIZE,
                depths: &self.faces[face],
            };
            let at = LIGHT + place;
            let receiver = reference::receiver(uniform, self.filter, self.bias, at, normal);
            let Some(band) = band(uniform, self.filter, self.bias, at, normal, &receiver) else {
                return (0.0, 1.0);
            };
            // The band is that of a position known to 2u of its reach, 8u with the matrix. Here the
            // position results from a normalisation (4u) and a quotient of two dot products, whose
            // relative error is 6u over the cosine of incidence: 34u for the least cosine of this
            // test, 0.2. Six bands include both.
            let band = Band {
                texel: band.texel * 6.0,
                depth: band.depth * 6.0,
                gradient: band.gradient * 6.0,
            };
            let depth = band.reference_depth(self.filter, &receiver);
            for corner in 0..8 {
                let sign = |bit: u32| if corner >> bit & 1 == 1 { 1.0 } else { -1.0 };
                let moved = Receiver {
                    texel: receiver.texel + DVec2::new(sign(0), sign(1)) * band.texel,
                    depth: receiver.depth + sign(2) * depth,
                    ..receiver
                };
                let seen = reference::visibility(self.filter, &map, &moved);
                range = (range.0.min(seen), range.1.max(seen));
            }
        }
        range
    }
}

fn scene() -> Scene {
    let slab = |center: Vec3, half: f32| Mesh::cuboid(center - half, center + Vec3::splat(half));
    Scene::new(
        gpu(),
        &[
            Mesh::cuboid(Vec3::splat(-4.0), Vec3::splat(4.0)),
            slab(Vec3::new(2.0, 1.4, 0.3), 0.5),
            slab(Vec3::new(-1.4, -0.8, -1.5), 0.4),
            Mesh::sphere(Vec3::new(0.4, -1.4, 1.2), 0.7, 10),
        ],
    )
}

fn compare(filter: Filter, bias: Bias, with_camera: bool) {
    let gpu = gpu();
    let scene = scene();
    let descriptor = OmniShadowDescriptor {
        map_size: MAP_SIZE,
        filter,
        bias,
        ..Default::default()
    };
    let mut shadow = OmniShadow::new(&gpu.device, &descriptor).expect("a valid lamp");
    let ask = Ask::light(gpu, shadow.maps());
    // The image is so wide that every face is seen; only the camera's position matters.
    let eye = DVec3::new(3.5, 3.0, 3.5);
    let camera = Camera::modern(eye, DVec3::new(-1.0, -1.0, -1.0), 2.6, 1.0).view();
    let frame = OmniFrame {
        origin: DVec3::ZERO,
        light: OmniLight {
            position_world: LIGHT,
            range: RANGE,
        },
        camera: with_camera.then_some(camera),
        casters: &scene.list(),
        receivers: &[Aabb::new(Vec3::splat(-6.0), Vec3::splat(6.0))],
    };
    let report = record_omni(gpu, &mut shadow, &frame).expect("a valid frame");
    assert_eq!(report.passes, 6);
    // This is the camera's position as the uniform has it.
    let camera: [f32; 4] = member(&shadow.maps().view_uniforms()[0], "camera");
    let camera = Vec3::from_slice(&camera[..3]).as_dvec3();
    let reference = Reference {
        uniforms: shadow.maps().view_uniforms().to_vec(),
        faces: (0..6)
            .map(|layer| readback::depth_layer(gpu, shadow.maps().texture(), layer))
            .collect(),
        filter,
        bias,
        eye: with_camera.then_some(camera),
    };
    assert!(!with_camera || camera.distance(eye) < 1e-4, "{camera}");
    let mut random = Random::new(59);
    let mut points = Vec::new();
    while points.len() < 3000 {
        let triangle = scene.triangles[random.index(scene.triangles.len())];
        let place = triangle.point(random.unit(), random.unit());
        let normal = triangle.normal() * triangle.normal().dot(LIGHT - place).signum();
        if normal.dot((LIGHT - place).normalize()) > 0.2 {
            points.push(Point::rounded(place, normal));
        }
    }
    let (mut undecided, mut partial) = (0, 0);
    for (point, seen) in points.iter().zip(ask.points(gpu, &points)) {
        let wide = |v| Vec3::from_array(v).as_dvec3();
        let (low, high) = reference.range(wide(point.position), wide(point.normal));
        // Whole numbers up to 64 are exact; one division remains.
        let seen = f64::from(seen);
        let context = format!("{filter:?} {bias:?} {point:?}: {seen} outside {low}..{high}");
        assert!((low - U..=high + U).contains(&seen), "{context}");
        undecided += usize::from(high > low);
        partial += usize::from(low == high && low > 0.0 && high < 1.0);
    }
    // A point is undecided if any of its samples is: of 64 samples, one in some hundred straddles
    // the border of a texel.
    assert!(undecided < points.len() / 5, "{undecided} undecided");
    assert!(partial > points.len() / 50, "{partial} partly lit");
}

#[test]
fn the_grid_is_the_mean_of_64() {
    compare(Filter::DirectionGrid { radius: 0.1 }, Bias::Auto, false);
}

#[test]
fn the_star_is_the_mean_of_20() {
    compare(Filter::DirectionStar { radius: 0.06 }, Bias::Auto, false);
}

#[test]
fn the_star_widens_away_from_the_camera() {
    compare(Filter::DirectionStar { radius: 0.06 }, Bias::Auto, true);
}

/// With the manual bias the samples lie at the receiver's distance.
#[test]
fn the_textbook_grid_is_the_mean_of_64() {
    let bias = Bias::Manual {
        constant: 0.05,
        slope: 0.1,
    };
    compare(Filter::DirectionGrid { radius: 0.1 }, bias, false);
}
