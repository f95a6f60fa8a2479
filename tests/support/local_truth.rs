//! Computes the shadows of a local light by a ray caster in f64, away from their edges.

use glam::DVec3;

use crate::support::probe::Point;
use crate::support::random::Random;
use crate::support::scene::Triangle;

/// Holds receivers whose truth is the same over the whole footprint of a lookup.
#[derive(Default)]
pub struct Settled {
    pub points: Vec<Point>,
    pub dark: Vec<bool>,
    /// Counts the receivers that were omitted because an edge of a shadow, or of the surface, crosses their footprint.
    pub at_edges: usize,
}

impl Settled {
    /// Returns how many are dark, and how many are lit.
    pub fn counts(&self) -> [usize; 2] {
        let dark = self.dark.iter().filter(|dark| **dark).count();
        [dark, self.dark.len() - dark]
    }

    /// Asserts that every visibility is the truth, up to the rounding of a sum of at most 64 weights, sharpened three
    /// times.
    pub fn assert_agrees(&self, seen: &[f32], name: &str) {
        for ((point, dark), seen) in self.points.iter().zip(&self.dark).zip(seen) {
            let wanted = if *dark { 0.0 } else { 1.0 };
            assert!(
                (seen - wanted).abs() <= 192.0 * f32::EPSILON,
                "{name}: {seen} where {wanted} is true, at {point:?}"
            );
        }
    }
}

/// Returns those of `count` receivers on the lit sides of `triangles` that are settled: the ray through the receiver
/// and sixteen rays around it, at an angle whose tangent is `tangent`, meet the receiver's plane at positions that are
/// all dark or all lit.
pub fn settled(
    triangles: &[Triangle],
    light: DVec3,
    tangent: f64,
    count: usize,
    random: &mut Random,
    wanted: impl Fn(DVec3) -> bool,
) -> Settled {
    let mut settled = Settled::default();
    for _ in 0..count {
        let triangle = triangles[random.index(triangles.len())];
        let place = triangle.point(random.unit(), random.unit());
        let to_light = light - place;
        let normal = triangle.normal() * triangle.normal().dot(to_light).signum();
        let facing = normal.dot(to_light.normalize());
        // On surfaces nearly edge-on the footprint extends over everything around them.
        if facing < 0.1 || !wanted(place) {
            continue;
        }
        let dark_at = |at: DVec3| hides(triangles, at, light);
        let dark = dark_at(place);
        let from_light = -to_light;
        let axis = from_light.normalize();
        let side = axis.any_orthonormal_vector();
        let across = side.cross(axis);
        let around = (0..16).map(|step| {
            let angle = f64::from(step) * std::f64::consts::TAU / 8.0;
            let radius = tangent * if step < 8 { 1.0 } else { 0.4 };
            let aside = (side * angle.cos() + across * angle.sin()) * from_light.length();
            let direction = from_light + aside * radius;
            light + direction * (normal.dot(from_light) / normal.dot(direction))
        });
        let mut all_same = true;
        for at in around {
            all_same &= dark_at(at) == dark;
        }
        if all_same {
            settled.points.push(Point::rounded(place, normal));
            settled.dark.push(dark);
        } else {
            settled.at_edges += 1;
        }
    }
    settled
}

/// Returns whether anything lies between `point` and the light.
fn hides(triangles: &[Triangle], point: DVec3, light: DVec3) -> bool {
    let between = 1e-7..1.0;
    triangles
        .iter()
        .filter_map(|triangle| triangle.hit(point, light - point))
        .any(|t| between.contains(&t))
}
