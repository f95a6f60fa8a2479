//! Tests that no seam between the faces of a point light's cube shows.

use glam::{DVec3, Vec3};
use shadow_support::mesh::Mesh;
use shadow_support::probe::Point;
use shadow_support::random::Random;
use shadow_support::triangle::Triangle;
use wgpu_shadows::{Bias, Filter};

use crate::fixtures::gpu::{Gpu, gpu};
use crate::fixtures::scene::Scene;
use crate::fixtures::table;
use crate::suite::omni::{EVERYWHERE, Lamp};

/// Returns how many of the points are in shadow, and how dark the darkest is. Visibilities one
/// step of 8 bits below 1 count as 1.
fn false_shadows(lamp: &Lamp, gpu: &Gpu, points: &[Point]) -> (usize, f32) {
    let seen = lamp.ask.points(gpu, points);
    let lit = 1.0 - 1.0 / 255.0..=1.0;
    let dark = seen.iter().filter(|seen| !lit.contains(*seen)).count();
    (dark, seen.iter().copied().fold(1.0, f32::min))
}

/// Returns directions to the seams: along the twelve edges between two faces and into the eight
/// corners, the tie itself (exact in f32) and positions up to five texels beside it.
fn seam_directions(texel: f64) -> Vec<DVec3> {
    let beside = [0.0, 1e-7, 0.2, 0.5, 1.0, 1.7, 2.5, 5.0].map(|texels| texels * texel);
    let mut directions = Vec::new();
    for signs in 0..8 {
        let sign = |bit: u32| if signs >> bit & 1 == 1 { -1.0 } else { 1.0 };
        for step in 0..=16 {
            // Eighths and halves are exact; the last step is the corner.
            let along = f64::from(step) / 16.0;
            for (index, off) in beside.iter().enumerate() {
                let off = if index % 2 == 0 {
                    1.0 + off
                } else {
                    1.0 / (1.0 + off)
                };
                let (a, b, c) = (sign(0), sign(1) * off, sign(2) * along);
                directions.extend([
                    DVec3::new(a, b, c),
                    DVec3::new(b, c, a),
                    DVec3::new(c, a, b),
                ]);
            }
        }
    }
    directions
}

/// Returns the points where rays from the light into the seams first meet the triangles, with the
/// normal of the lit side. Points nearer to the border of their triangle than a kernel reaches
/// (`border`, a tangent) are omitted where the neighbouring triangle has another inclination.
fn seam_points(triangles: &[Triangle], light: DVec3, texel: f64, border: f64) -> Vec<Point> {
    let mut points = Vec::new();
    for direction in seam_directions(texel) {
        let nearest = triangles
            .iter()
            .filter_map(|triangle| triangle.hit(light, direction).map(|t| (t, triangle)))
            .filter(|(t, _)| *t > 0.0)
            .min_by(|a, b| a.0.total_cmp(&b.0));
        let Some((t, triangle)) = nearest else {
            continue;
        };
        let place = light + direction * t;
        let normal = triangle.normal() * -triangle.normal().dot(direction).signum();
        let facing = -normal.dot(direction.normalize());
        let clear = border * place.distance(light) / facing;
        if facing > 0.02 && distance_to_border(triangle, place) >= clear {
            points.push(Point::rounded(place, normal));
        }
    }
    points
}

fn distance_to_border(triangle: &Triangle, place: DVec3) -> f64 {
    let [a, b, c] = triangle.0;
    [(a, b), (b, c), (c, a)]
        .map(|(from, to)| (place - from).cross((to - from).normalize()).length())
        .into_iter()
        .fold(f64::INFINITY, f64::min)
}

fn planar_samplings() -> impl Iterator<Item = (Filter, Bias)> {
    let more = [
        Filter::default(),
        Filter::Pcss { light_size: 0.05 },
        Filter::Tent7 { sharpness: 2.0 },
    ];
    Filter::PLANAR
        .iter()
        .copied()
        .chain(more)
        .flat_map(|filter| [Bias::Auto, Bias::NormalOffset].map(|bias| (filter, bias)))
}

const SEAM_MAP: u32 = 250;

/// Returns planes around the light that all extend across seams and corners, one at a time: six
/// along the axes at a distance that makes ties exact, and oblique ones; and a sphere of large
/// facets around the light.
fn seam_scenes(gpu: &Gpu) -> Vec<(String, Scene, DVec3, Vec<Point>)> {
    let texel = 2.0 / f64::from(SEAM_MAP);
    let mut random = Random::new(41);
    let mut scenes = Vec::new();
    let light = DVec3::new(0.5, 1.0, -0.25);
    let axes = [DVec3::X, DVec3::Y, DVec3::Z];
    let along_axes = axes.into_iter().flat_map(|axis| [axis, -axis]);
    let oblique: Vec<_> = (0..6).map(|_| random.direction()).collect();
    for normal in along_axes.chain(oblique) {
        let u = normal.any_orthonormal_vector();
        let v = normal.cross(u);
        let corner = light - normal * 2.0 - (u + v) * 12.0;
        let sheet = Mesh::sheet(corner.as_vec3(), (u * 24.0).as_vec3(), (v * 24.0).as_vec3());
        let scene = Scene::new(gpu, &[sheet]);
        let points = seam_points(&scene.triangles, light, texel, 0.0);
        assert!(points.len() > 300, "{normal}: {} points", points.len());
        scenes.push((format!("plane {normal}"), scene, light, points));
    }
    let sphere = Mesh::sphere(Vec3::new(0.4, 1.1, -0.1), 3.0, 5);
    let scene = Scene::new(gpu, &[sphere]);
    // Facets lean toward each other: a kernel of the widest filter, its border and a texel of
    // rounding stay on one facet. Texels grow toward the corners of a face, by the square root of
    // three at most.
    let points = seam_points(&scene.triangles, light, texel, 6.0 * texel * 3.0_f64.sqrt());
    assert!(points.len() > 300, "sphere: {} points", points.len());
    scenes.push(("sphere".to_owned(), scene, light, points));
    scenes
}

#[test]
fn seams_are_lit() {
    let gpu = gpu();
    let scenes = seam_scenes(gpu);
    let (mut failures, mut asked) = (Vec::new(), 0);
    for (filter, bias) in planar_samplings() {
        let mut lamp = Lamp::new(gpu, SEAM_MAP, filter, bias);
        for (name, scene, light, points) in &scenes {
            let report = lamp.record(gpu, scene, *light, None, &EVERYWHERE);
            assert!(report.passes >= 3, "{name}: {report:?}");
            // PCSS searches for occluders up to 33 texels around, and on a sphere it finds the
            // other facets.
            if matches!(filter, Filter::Pcss { .. }) && name == "sphere" {
                continue;
            }
            let (dark, darkest) = false_shadows(&lamp, gpu, points);
            asked += points.len();
            if dark > 0 {
                let (count, lamp) = (points.len(), &lamp.name);
                failures.push(format!(
                    "{lamp} {name}: {dark} of {count} in shadow, down to {darkest}"
                ));
            }
        }
    }
    assert!(
        failures.is_empty(),
        "{}\n{}",
        gpu.describe(),
        failures.join("\n")
    );
    table::record(
        "edges and corners of a cube, ties included, on planes and in a sphere",
        "no receiver darker than lit less 1/255, under every filter and derived bias",
        format!("0 of {asked} receivers"),
    );
}

/// The same receivers are in the maps, on both sides of every seam: without a bias they shadow
/// themselves.
#[test]
fn seams_would_shadow_themselves() {
    let gpu = gpu();
    let none = Bias::Manual {
        constant: 0.0,
        slope: 0.0,
    };
    let mut lamp = Lamp::new(gpu, SEAM_MAP, Filter::Bilinear { sharpness: 1.0 }, none);
    for (name, scene, light, points) in seam_scenes(gpu) {
        lamp.record(gpu, &scene, light, None, &EVERYWHERE);
        let (dark, _) = false_shadows(&lamp, gpu, &points);
        // Half of a kernel lies behind a plane that leans, and all planes here lean at their seams.
        assert!(
            dark > points.len() / 3,
            "{name}: {dark} of {}",
            points.len()
        );
    }
}
