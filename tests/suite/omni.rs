//! Tests point lights: no seam between the faces shows, the shadows are where a ray caster has
//! them, and the faces cost no more than they must.

use glam::{DVec3, Vec3};
use shadow_support::camera::Camera;
use shadow_support::mesh::Mesh;
use shadow_support::probe::Point;
use shadow_support::random::Random;
use shadow_support::triangle::Triangle;
use wgpu_shadows::{
    Aabb, Bias, CameraView, Filter, OmniLight, OmniShadow, OmniShadowDescriptor,
    report::ShadowReport, report::ViewStatus,
};

use crate::fixtures::ask::{Ask, record_omni};
use crate::fixtures::frames::OmniFrame;
use crate::fixtures::gpu::{Gpu, gpu};
use crate::fixtures::local_truth::settled;
use crate::fixtures::scene::Scene;
use crate::fixtures::table;

/// Makes all of space receive, so that every caster is drawn, including a flat wall with nothing
/// behind it.
const EVERYWHERE: [Aabb; 1] = [Aabb::new(Vec3::splat(-40.0), Vec3::splat(40.0))];

/// Holds a light and the probe that samples it.
struct Lamp {
    shadow: OmniShadow,
    ask: Ask,
    name: String,
}

impl Lamp {
    fn new(gpu: &Gpu, map_size: u32, filter: Filter, bias: Bias) -> Self {
        let descriptor = OmniShadowDescriptor {
            map_size,
            filter,
            bias,
            ..Default::default()
        };
        let shadow = OmniShadow::new(&gpu.device, &descriptor).expect("a valid lamp");
        Self {
            ask: Ask::light(gpu, shadow.maps()),
            shadow,
            name: format!("{filter:?} {bias:?} map {map_size}"),
        }
    }

    fn record(
        &mut self,
        gpu: &Gpu,
        scene: &Scene,
        light: DVec3,
        camera: Option<CameraView>,
        receivers: &[Aabb],
    ) -> ShadowReport {
        let frame = OmniFrame {
            origin: DVec3::ZERO,
            light: OmniLight {
                position_world: light,
                range: 60.0,
            },
            camera,
            casters: &scene.list(),
            receivers,
        };
        record_omni(gpu, &mut self.shadow, &frame).expect("a valid frame")
    }

    /// Returns how many of the points are in shadow, and how dark the darkest is. Visibilities one
    /// step of 8 bits below 1 count as 1.
    fn false_shadows(&self, gpu: &Gpu, points: &[Point]) -> (usize, f32) {
        let seen = self.ask.points(gpu, points);
        let lit = 1.0 - 1.0 / 255.0..=1.0;
        let dark = seen.iter().filter(|seen| !lit.contains(*seen)).count();
        (dark, seen.iter().copied().fold(1.0, f32::min))
    }
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
            let (dark, darkest) = lamp.false_shadows(gpu, points);
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
        let (dark, _) = lamp.false_shadows(gpu, &points);
        // Half of a kernel lies behind a plane that leans, and all planes here lean at their seams.
        assert!(
            dark > points.len() / 3,
            "{name}: {dark} of {}",
            points.len()
        );
    }
}

/// Returns a room with solids around a light.
fn furnished(gpu: &Gpu) -> Scene {
    let slab = |x: f32, y: f32, z: f32, half: f32| {
        let center = Vec3::new(x, y, z);
        Mesh::cuboid(center - half, center + Vec3::splat(half))
    };
    Scene::new(
        gpu,
        &[
            Mesh::cuboid(Vec3::splat(-5.0), Vec3::splat(5.0)),
            slab(2.5, 0.3, 0.4, 0.6),
            slab(-2.0, 1.8, 2.1, 0.5),
            slab(-1.4, -2.0, -1.2, 0.4),
            slab(0.4, 2.6, -0.4, 0.5),
            Mesh::sphere(Vec3::new(0.3, -0.6, -2.6), 0.8, 12),
            Mesh::sphere(Vec3::new(1.8, -1.9, 1.8), 0.5, 12),
        ],
    )
}

#[test]
fn shadows_are_where_rays_have_them() {
    let gpu = gpu();
    let scene = furnished(gpu);
    const MAP: u32 = 400;
    let mut random = Random::new(43);
    for (filter, bias) in [
        (Filter::default(), Bias::Auto),
        (Filter::Tent7 { sharpness: 1.0 }, Bias::Auto),
        (Filter::Box, Bias::NormalOffset),
        (Filter::Hardware, Bias::Auto),
    ] {
        let mut lamp = Lamp::new(gpu, MAP, filter, bias);
        for light in [DVec3::new(0.21, 0.1, -0.13), DVec3::new(-3.1, 2.9, -2.2)] {
            lamp.record(gpu, &scene, light, None, &EVERYWHERE);
            // The distance is the reach, half a texel of stairs, and the residual offset; toward a
            // face's corner along both axes at once.
            let texels = (filter.reach_texels() + 1.5) * 2.0_f64.sqrt() * 1.05;
            let tangent = texels * 2.0 / f64::from(MAP);
            let all = |_: DVec3| true;
            let truth = settled(&scene.triangles, light, tangent, 6000, &mut random, all);
            let [dark, lit] = truth.counts();
            assert!(dark > 80 && lit > 1500, "{dark} dark, {lit} lit");
            let seen = lamp.ask.points(gpu, &truth.points);
            truth.assert_agrees(&seen, &lamp.name);
        }
    }
}

/// Beyond the range everything is lit, and up to it the shadow is there: the border lies within the
/// rounding of a squared distance.
#[test]
fn shadows_end_at_the_range() {
    let gpu = gpu();
    let plate = Mesh::cuboid(Vec3::new(-1.0, -1.0, 1.9), Vec3::new(1.0, 1.0, 2.0));
    let scene = Scene::new(gpu, &[plate]);
    let mut lamp = Lamp::new(gpu, 128, Filter::default(), Bias::Auto);
    for range in [4.0, 7.5_f32] {
        let frame = OmniFrame {
            origin: DVec3::ZERO,
            light: OmniLight {
                position_world: DVec3::ZERO,
                range,
            },
            camera: None,
            casters: &scene.list(),
            receivers: &EVERYWHERE,
        };
        record_omni(gpu, &mut lamp.shadow, &frame).expect("a valid frame");
        let mut random = Random::new(47);
        let mut points = Vec::new();
        for _ in 0..200 {
            let direction = DVec3::new(random.range(-0.3, 0.3), random.range(-0.3, 0.3), 1.0);
            // Six roundings of a relative error of 2^-24 are 4e-7.
            for share in [0.7, 1.0 - 1e-6, 1.0 + 1e-6, 1.5] {
                let place = direction.normalize() * (f64::from(range) * share);
                points.push(Point::rounded(place, DVec3::NEG_Z));
            }
        }
        let seen = lamp.ask.points(gpu, &points);
        for (four, points) in seen.chunks(4).zip(points.chunks(4)) {
            assert_eq!(four, [0.0, 0.0, 1.0, 1.0], "range {range}, {points:?}");
        }
    }
}

#[test]
fn casters_on_one_side_cost_one_face() {
    let gpu = gpu();
    let crate_mesh = Mesh::cuboid(Vec3::new(3.0, -0.8, -0.6), Vec3::new(4.0, 0.7, 0.9));
    let scene = Scene::new(gpu, &[crate_mesh]);
    let mut lamp = Lamp::new(gpu, 64, Filter::default(), Bias::Auto);
    let report = lamp.record(gpu, &scene, DVec3::ZERO, None, &EVERYWHERE);
    // A crate has twelve triangles, and they are drawn into one face.
    assert_eq!(
        (report.passes, report.draws(), report.triangles()),
        (1, 1, 12)
    );
    let statuses: Vec<_> = report.views.iter().map(|view| view.status).collect();
    let mut wanted = [ViewStatus::Empty; 6];
    wanted[0] = ViewStatus::Drawn;
    assert_eq!(statuses, wanted);
    // The shadow is there, and all other sides are lit.
    let sides = [
        Vec3::X,
        Vec3::NEG_X,
        Vec3::Y,
        Vec3::NEG_Y,
        Vec3::Z,
        Vec3::NEG_Z,
    ];
    let points = sides.map(|side| Point::new(side * 8.0, -side));
    assert_eq!(
        lamp.ask.points(gpu, &points),
        [0.0, 1.0, 1.0, 1.0, 1.0, 1.0]
    );
}

/// A camera that looks one way needs one face of six, and sees in it what it saw with all of them.
#[test]
fn faces_that_no_camera_sees_are_empty() {
    let gpu = gpu();
    let axes = [
        Vec3::X,
        Vec3::NEG_X,
        Vec3::Y,
        Vec3::NEG_Y,
        Vec3::Z,
        Vec3::NEG_Z,
    ];
    let crates = axes.map(|axis| Mesh::cuboid(axis * 3.0 - 0.4, axis * 3.0 + Vec3::splat(0.4)));
    let scene = Scene::new(gpu, &crates);
    let mut lamp = Lamp::new(gpu, 128, Filter::default(), Bias::Auto);
    let all = lamp.record(gpu, &scene, DVec3::ZERO, None, &EVERYWHERE);
    assert_eq!((all.passes, all.draws(), all.triangles()), (6, 6, 72));
    let points: Vec<_> = (0..50)
        .map(|step| Point::new(Vec3::new(8.0, step as f32 * 0.04, 0.3), Vec3::NEG_X))
        .collect();
    let before = lamp.ask.points(gpu, &points);
    assert!(before.contains(&0.0) && before.contains(&1.0));
    for (index, axis) in axes.into_iter().enumerate() {
        let up = if axis.y == 0.0 { 0.0 } else { 1e-3 };
        let target = axis.as_dvec3() + DVec3::new(up, 0.0, 0.0);
        let camera = Camera::modern(DVec3::ZERO, target, 0.9, 1.0).view();
        let report = lamp.record(gpu, &scene, DVec3::ZERO, Some(camera), &EVERYWHERE);
        for (face, view) in report.views.iter().enumerate() {
            let is_empty = view.status == ViewStatus::Empty;
            assert_eq!(is_empty, face != index, "{axis}: {report:?}");
        }
        if index == 0 {
            // Other light-space bounds have other texels; along a straight edge they blur over at
            // most one texel.
            let after = lamp.ask.points(gpu, &points);
            let differ = before.iter().zip(&after).filter(|(a, b)| a != b).count();
            assert!(differ <= 6, "{differ} of 50 differ: {before:?} {after:?}");
        }
    }
}
