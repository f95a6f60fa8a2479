//! Tests where two planes meet: a ridge does not shadow itself, and a valley only within the kernel
//! of its crease.

use glam::{DVec3, Vec3};
use shadow_support::mesh::Mesh;
use shadow_support::probe::Point;
use shadow_support::random::Random;
use shadow_support::triangle::Triangle;
use wgpu_shadows::{Aabb, Bias, CascadeLayout, DirectionalShadowDescriptor, Filter};

use super::stage::{Sun, scene, shining};
use super::table;
use crate::fixtures::frames::Coverage;
use crate::fixtures::gpu::gpu;

const LENGTH: f64 = 4.0;

/// Describes two planes that meet in a line along `along` and descend from it by `slopes` (negative
/// ones ascend, as in a valley).
struct Crease {
    name: String,
    along: DVec3,
    sheets: [Mesh; 2],
    triangles: Vec<Triangle>,
    light: DVec3,
}

impl Crease {
    fn new(slopes: [f64; 2], heading: f64, light: DVec3) -> Self {
        let along = DVec3::new(heading.cos(), 0.0, heading.sin());
        let across = DVec3::Y.cross(along);
        let start = along * (-0.5 * LENGTH);
        let sides = [1.0, -1.0].into_iter().zip(slopes);
        let mut sheets = sides.map(|(side, slope)| {
            let away = across * (side * 2.0) - DVec3::Y * (2.0 * slope);
            let (u, v) = (along * LENGTH, away);
            Mesh::sheet(start.as_vec3(), u.as_vec3(), v.as_vec3())
        });
        let sheets = [(); 2].map(|()| sheets.next().expect("two sides"));
        let triangles = sheets
            .iter()
            .flat_map(|sheet| sheet.triangles(&glam::Mat4::IDENTITY))
            .collect();
        Self {
            name: format!("slopes {slopes:?} heading {heading} light {light}"),
            along,
            sheets,
            triangles,
            light: light.normalize(),
        }
    }

    /// Returns receivers on both sides, and their distances from the crease as the light sees it.
    /// Normals face up, where the light is.
    fn receivers(&self, random: &mut Random) -> Vec<(Point, f64)> {
        (0..1200)
            .filter_map(|index| {
                let triangle = self.triangles[index % self.triangles.len()];
                let normal = triangle.normal();
                let normal = normal * normal.y.signum();
                if -normal.dot(self.light) < 0.02 {
                    return None;
                }
                // Most of them are near the crease, and none near its ends, where the sheets end.
                let place = triangle.point(random.unit(), random.unit());
                let along = self.along * place.dot(self.along);
                let place = along + (place - along) * random.unit().powi(3);
                if along.length() > 0.4 * LENGTH {
                    return None;
                }
                let line = self.along.reject_from_normalized(self.light).normalize();
                let seen = place.reject_from_normalized(self.light);
                let distance = seen.reject_from_normalized(line).length();
                Some((Point::rounded(place, normal), distance))
            })
            .collect()
    }

    /// Returns whether both sides face the light. Otherwise one truly shadows the other, or itself.
    fn both_lit(&self) -> bool {
        self.triangles.iter().all(|triangle| {
            let normal = triangle.normal();
            -(normal * normal.y.signum()).dot(self.light) > 0.02
        })
    }
}

fn lights() -> [DVec3; 5] {
    [
        DVec3::NEG_Y,
        DVec3::new(0.5, -1.0, 0.2),
        DVec3::new(-0.8, -1.0, 0.6),
        DVec3::new(1.5, -1.0, 0.1),
        DVec3::new(-0.3, -1.0, -2.0),
    ]
}

fn creases(signs: f64) -> Vec<Crease> {
    let slopes = [[0.1, 0.1], [0.6, 0.2], [1.0, 1.0], [0.0, 2.0], [4.0, 4.0]];
    let mut creases = Vec::new();
    for slopes in slopes {
        for heading in [0.0, 0.7, 2.1] {
            for light in lights() {
                creases.push(Crease::new(slopes.map(|s| s * signs), heading, light));
            }
        }
    }
    creases.retain(Crease::both_lit);
    assert!(creases.len() > 20, "{} creases", creases.len());
    creases
}

fn samplings() -> Vec<(Filter, Bias)> {
    Filter::PLANAR
        .iter()
        .copied()
        .chain([Filter::default()])
        .flat_map(|filter| [(filter, Bias::Auto), (filter, Bias::NormalOffset)])
        .collect()
}

/// Returns the distances from the crease, in texels, of the receivers that are in shadow, for all
/// creases, and how many were sampled.
fn false_shadows(signs: f64, filter: Filter, bias: Bias) -> (Vec<(f64, String)>, usize) {
    let mut sun = Sun::new(&DirectionalShadowDescriptor {
        map_size: 128,
        filter,
        bias,
        layout: CascadeLayout::fixed(1),
        ..Default::default()
    });
    let (mut found, mut asked) = (Vec::new(), 0);
    for crease in creases(signs) {
        let scene = scene(&crease.sheets);
        let all = crease
            .sheets
            .iter()
            .fold(Aabb::EMPTY, |all, sheet| all.union(sheet.bounds()));
        // A margin below gives the sheets something to cast onto, so that they are drawn.
        let cover = Aabb::new(all.min - Vec3::splat(0.5), all.max);
        let coverage = Coverage::Bounds(cover);
        let report = sun.record(
            DVec3::ZERO,
            shining(crease.light),
            coverage,
            &scene.list(),
            &[],
        );
        assert_eq!(report.draws(), 2, "{}", crease.name);
        let texel = f64::from(report.views[0].texel_size_world.min_element());
        let (points, distances): (Vec<_>, Vec<_>) =
            crease.receivers(&mut Random::new(3)).into_iter().unzip();
        asked += points.len();
        for (seen, distance) in sun.ask(&points).into_iter().zip(distances) {
            if !(1.0 - 1.0 / 255.0..=1.0).contains(&seen) {
                let name = format!("{} {filter:?} {bias:?}: {seen}", crease.name);
                found.push((distance / texel, name));
            }
        }
    }
    (found, asked)
}

/// On a ridge every texel on the far side lies lower than the receiver's plane: nothing may be
/// darker than 1/255 below lit.
#[test]
fn ridges_are_lit() {
    let mut all = 0;
    let mut failures = Vec::new();
    for (filter, bias) in samplings() {
        let (found, asked) = false_shadows(1.0, filter, bias);
        all += asked;
        failures.extend(
            found
                .into_iter()
                .map(|(texels, name)| format!("{name} at {texels} texels")),
        );
    }
    table::record(
        "ridges",
        "no false shadow",
        format!("{} of {all} receivers", failures.len()),
    );
    let first = &failures[..failures.len().min(10)];
    assert!(
        failures.is_empty(),
        "{}: {} of {all}\n{}",
        gpu().describe(),
        failures.len(),
        first.join("\n")
    );
}

/// In a valley the far side rises above the receiver's plane, so a kernel that reaches across the
/// crease sees it as a caster. It reaches K texels per axis, at most √2 K from the crease; a
/// receiver that is moved along its normal gets at most `√2 K` further. Half a texel is for the
/// area that a texel's centre represents.
#[test]
fn false_shadow_in_valleys_stays_at_the_crease() {
    let (mut all, mut farthest_share) = (0, 0.0_f64);
    for (filter, bias) in samplings() {
        let (found, asked) = false_shadows(-1.0, filter, bias);
        all += asked;
        let root = std::f64::consts::SQRT_2;
        let moved = match bias {
            Bias::NormalOffset => filter.reach_texels() * root,
            _ if !filter.compares_each_texel() => filter.reach_texels() * root,
            _ => 0.1 * root,
        };
        let limit = filter.reach_texels() * root + moved + 0.5;
        let farthest = found.iter().max_by(|a, b| a.0.total_cmp(&b.0));
        if let Some((distance, name)) = farthest {
            assert!(
                *distance <= limit,
                "{}: {name} at {distance} texels of {limit}",
                gpu().describe()
            );
            farthest_share = farthest_share.max(distance / limit);
        }
    }
    table::record(
        "valleys",
        "false shadow within the kernel's reach of the crease",
        format!(
            "up to {farthest_share:.2} of the reach, of {all} receivers under every filter and derived bias"
        ),
    );
}
