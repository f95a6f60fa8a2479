//! What a ray caster in f64 says of the shadows of a light at a place, away from their edges.

use glam::DVec3;

use crate::support::camera::Camera;
use crate::support::probe::Point;
use crate::support::random::Random;
use crate::support::scene::Triangle;

/// Receivers whose truth is the same over the whole footprint of a lookup.
#[derive(Default)]
pub struct Settled {
    pub points: Vec<Point>,
    pub dark: Vec<bool>,
    /// Receivers left out because an edge of a shadow, or of the surface, crosses their footprint.
    pub at_edges: usize,
}

/// What a lookup of a local light may take for the receiver.
#[derive(Clone, Copy, Debug)]
pub struct Lookup {
    pub light: DVec3,
    /// How far aside its footprint reaches, as a tangent seen from the light.
    pub tangent: f64,
    /// How far along the normal rounding may move it, with its footprint.
    pub lift: f64,
    /// By which share of its way to the light rounding may move it.
    pub nearer: f64,
}

impl Settled {
    /// How many are dark, and how many lit.
    pub fn counts(&self) -> [usize; 2] {
        let dark = self.dark.iter().filter(|dark| **dark).count();
        [dark, self.dark.len() - dark]
    }

    /// Adds the receiver at `place` if its truth is settled; sides that face away from the light, or nearly edge on, are left
    /// out: they see their footprint stretched over all that is around them.
    fn add(&mut self, triangles: &[Triangle], lookup: &Lookup, place: DVec3, normal: DVec3) {
        let &Lookup {
            light,
            tangent,
            lift,
            nearer,
        } = lookup;
        let from_light = place - light;
        if -normal.dot(from_light.normalize()) < 0.1 {
            return;
        }
        let dark_at = |at: DVec3| hides(triangles, at, light);
        let dark = dark_at(place);
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
        // The lookup lifts the plane by a way toward the light, along which the texel is the same.
        let share = (lift / -normal.dot(from_light)).min(0.5);
        let moves = if lift > 0.0 { 3 } else { 1 };
        let lifted = |at: DVec3| {
            let moved = [at, at + normal * lift, at + (light - at) * share];
            moved.into_iter().take(moves)
        };
        for at in around.chain([place]).flat_map(lifted) {
            all_same &= dark_at(at) == dark && dark_at(at + (light - at) * nearer) == dark;
        }
        if all_same {
            self.points.push(Point::rounded(place, normal));
            self.dark.push(dark);
        } else {
            self.at_edges += 1;
        }
    }

    /// How many dark receivers were seen lit, and how many lit ones darker than lit, beyond the rounding of a sum of at most 64
    /// weights, sharpened three times.
    pub fn leaks_and_false_shadows(&self, seen: &[f32]) -> [usize; 2] {
        let band = 192.0 * f32::EPSILON;
        let mut wrong = [0; 2];
        for (dark, seen) in self.dark.iter().zip(seen) {
            let wanted = if *dark { 0.0 } else { 1.0 };
            let is_right = (seen - wanted).abs() <= band;
            wrong[usize::from(!dark)] += usize::from(!is_right);
        }
        wrong
    }

    /// Every answer is the truth, give or take the rounding of a sum of at most 64 weights, sharpened three times.
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

/// `count` receivers on the lit sides of `triangles`, of which those remain that are settled: the ray through the receiver
/// and sixteen rays around it, `tangent` (the tangent of an angle) aside, meet the receiver's plane at places that are all
/// dark or all lit.
pub fn settled(
    triangles: &[Triangle],
    light: DVec3,
    tangent: f64,
    count: usize,
    random: &mut Random,
    wanted: impl Fn(DVec3) -> bool,
) -> Settled {
    let mut settled = Settled::default();
    let lookup = Lookup {
        light,
        tangent,
        lift: 0.0,
        nearer: 0.0,
    };
    for _ in 0..count {
        let triangle = triangles[random.index(triangles.len())];
        let place = triangle.point(random.unit(), random.unit());
        let normal = triangle.normal() * triangle.normal().dot(light - place).signum();
        if wanted(place) {
            settled.add(triangles, &lookup, place, normal);
        }
    }
    settled
}

/// The receivers that a camera sees in `columns` by `rows` pixels on sides that face the light, of which those remain that are
/// settled, as [`settled`] has it.
pub fn settled_in_view(
    triangles: &[Triangle],
    camera: &Camera,
    (columns, rows): (u32, u32),
    lookup: &Lookup,
    wanted: impl Fn(DVec3) -> bool,
) -> Settled {
    let mut settled = Settled::default();
    for pixel in 0..columns * rows {
        let across = (f64::from(pixel % columns) + 0.5) / f64::from(columns);
        let up = (f64::from(pixel / columns) + 0.5) / f64::from(rows);
        let (eye, direction) = camera.ray(across, up);
        let hits = triangles
            .iter()
            .filter_map(|triangle| triangle.hit(eye, direction).map(|t| (t, triangle)));
        let nearest = hits
            .filter(|(t, _)| *t > 0.0)
            .min_by(|a, b| a.0.total_cmp(&b.0));
        let Some((t, triangle)) = nearest else {
            continue;
        };
        let place = eye + direction * t;
        let normal = triangle.normal() * -triangle.normal().dot(direction).signum();
        if wanted(place) {
            settled.add(triangles, lookup, place, normal);
        }
    }
    settled
}

/// Does anything lie between `point` and the light?
fn hides(triangles: &[Triangle], point: DVec3, light: DVec3) -> bool {
    let between = 1e-7..1.0;
    triangles
        .iter()
        .filter_map(|triangle| triangle.hit(point, light - point))
        .any(|t| between.contains(&t))
}
