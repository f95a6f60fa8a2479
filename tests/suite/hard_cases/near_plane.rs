//! Tests casters that begin before a near plane, be it that of the covered box, of the camera or of
//! the light: nothing of them is cut off.

use glam::{DVec3, Vec3};
use shadow_support::camera::{Camera, Lens, Pose};
use shadow_support::mesh::Mesh;
use shadow_support::probe::Point;
use shadow_support::random::Random;
use shadow_support::triangle::occluded;
use wgpu_shadows::{
    Aabb, Bias, Filter, OmniLight, OmniShadow, OmniShadowDescriptor, SpotLight, SpotShadow,
    SpotShadowDescriptor,
};

use super::stage::{SUM_ERROR, Sun, differ, scene, shining};
use super::table;
use crate::fixtures::ask::{Ask, record_omni, record_spot};
use crate::fixtures::frames::{Coverage, OmniFrame, SpotFrame};
use crate::fixtures::gpu::gpu;
use crate::fixtures::local_truth::settled;
use crate::fixtures::scene::Scene;

/// Returns a blade from below the floor to `top`, one triangle, which crosses every plane in
/// between.
fn blade(x: f32, z: f32, top: f32) -> Mesh {
    let corner = Vec3::new(x, -0.3, z);
    Mesh {
        positions: vec![
            corner - Vec3::X * 0.9,
            corner + Vec3::X * 0.9,
            Vec3::new(x + 0.2, top, z + 0.8),
        ],
        indices: vec![0, 1, 2],
    }
}

/// Compares the visibilities of the floor with rays, where 48 rays around, up to a kernel away,
/// agree.
fn compare(sun: &Sun, scene: &Scene, light: DVec3, wanted: impl Fn(DVec3) -> bool) -> [usize; 3] {
    let mut random = Random::new(83);
    let texel = sun.texel();
    // The distance is three texels, stretched by the slant of the light.
    let around = 3.0 * texel * light.length() / light.y.abs();
    let (mut points, mut truth) = (Vec::new(), Vec::new());
    for _ in 0..4000 {
        let place = random.point(DVec3::new(-4.5, 0.0, -4.5), DVec3::new(4.5, 0.0, 4.5));
        let place = place.as_vec3().as_dvec3();
        let blocked = |at: DVec3| occluded(&scene.triangles, at, -light, 1e-9);
        let here = blocked(place);
        let mut steps = (0..48).map(|k| {
            let angle = f64::from(k % 16) * std::f64::consts::TAU / 16.0;
            let share = f64::from(1 + k / 16) / 3.0;
            DVec3::new(angle.cos(), 0.0, angle.sin()) * around * share
        });
        if wanted(place) && steps.all(|step| blocked(place + step) == here) {
            points.push(Point::rounded(place, DVec3::Y));
            truth.push(here);
        }
    }
    let seen = sun.ask(&points);
    let right = |dark: &bool| if *dark { 0.0 } else { 1.0 };
    let pairs = truth.iter().zip(&seen);
    let wrong = pairs.filter(|(dark, seen)| differ(**seen, right(dark), SUM_ERROR));
    let dark = truth.iter().filter(|dark| **dark).count();
    [wrong.count(), dark, truth.len() - dark]
}

/// Casters in the covered box or in the camera's volume extend out of it toward the sun, through
/// the camera's near plane or behind it, up to a hundred kilometres; others lie outside completely.
#[test]
fn nothing_is_cut_off_on_the_way_from_the_sun() {
    let cover = Aabb::new(Vec3::new(-5.0, -0.1, -5.0), Vec3::new(5.0, 0.4, 5.0));
    let lens = Lens::Perspective {
        sides: [-0.4, 0.4, -0.4, 0.4],
        near: 1.0,
        far: 60.0,
    };
    // The camera's near plane cuts the blades, and some of them are behind it.
    let camera = Camera {
        pose: Pose::looking_at(DVec3::new(0.3, 3.0, 3.9), DVec3::new(0.1, 0.0, -1.0)),
        lens,
        reversed: true,
    };
    let (mut wrong, mut dark, mut lit) = (0, 0, 0);
    for top in [1.0_f32, 10.0, 1e3, 1e5] {
        let mut meshes = vec![Mesh::floor(0.0, 8.0)];
        let mut random = Random::new(79);
        for _ in 0..9 {
            let at = random
                .point(DVec3::splat(-3.8), DVec3::splat(3.8))
                .as_vec3();
            meshes.push(blade(at.x, at.z, top));
        }
        let scene = scene(&meshes);
        for light in [
            DVec3::NEG_Y,
            DVec3::new(0.2, -1.0, 0.35),
            DVec3::new(-1.2, -1.0, 0.4),
        ] {
            for coverage in [Coverage::Bounds(cover), Coverage::Camera(camera.view())] {
                let mut sun = Sun::of_size(512);
                let casters = scene.list();
                sun.record(DVec3::ZERO, shining(light), coverage, &casters, &[]);
                let sees = |place| match coverage {
                    Coverage::Camera(_) => camera.sees(place, f64::INFINITY, 0.01),
                    _ => true,
                };
                let [w, d, l] = compare(&sun, &scene, light.as_vec3().as_dvec3(), sees);
                wrong += w;
                dark += d;
                lit += l;
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
        "casters that straddle the near plane of a camera or a covered box, or lie before it, up to 1e5 high",
        "settled receivers as the truth says",
        format!(
            "{wrong} wrong of {} settled receivers, {dark} of them dark",
            dark + lit
        ),
    );
}

/// Returns a hall around a light, and long walls of two triangles that pass beside, above and below
/// it, from far behind to far ahead.
fn hall() -> Scene {
    let plank = |low: Vec3, high: Vec3| Mesh::cuboid(low, high);
    scene(&[
        Mesh::cuboid(Vec3::splat(-6.0), Vec3::splat(6.0)),
        plank(Vec3::new(0.4, -1.0, -5.5), Vec3::new(0.5, 0.3, 5.5)),
        plank(Vec3::new(-5.5, -0.7, -0.9), Vec3::new(5.5, -0.6, 0.2)),
        plank(Vec3::new(-0.9, -5.5, -0.5), Vec3::new(-0.7, 5.5, -0.1)),
    ])
}

/// Walls whose triangles lie on both sides of the light's own planes are cut at the light and
/// nowhere else.
#[test]
fn nothing_is_cut_off_beside_a_light() {
    let gpu = gpu();
    let scene = hall();
    let light = DVec3::new(0.1, 0.05, -0.02);
    let everywhere = [Aabb::new(Vec3::splat(-9.0), Vec3::splat(9.0))];
    let map_size = 512;
    let mut random = Random::new(89);
    let tangent = 3.5 * 2.0_f64.sqrt() * 2.0 / f64::from(map_size);
    let (mut wrong, mut dark, mut lit) = (0, 0, 0);
    let mut count = |truth: &crate::fixtures::local_truth::Settled, seen: &[f32]| {
        for (is_dark, seen) in truth.dark.iter().zip(seen) {
            let right = if *is_dark { 0.0 } else { 1.0 };
            wrong += usize::from(differ(*seen, right, SUM_ERROR));
            dark += usize::from(*is_dark);
            lit += usize::from(!is_dark);
        }
    };
    let descriptor = OmniShadowDescriptor {
        map_size,
        filter: Filter::default(),
        bias: Bias::Auto,
        ..Default::default()
    };
    let mut lamp = OmniShadow::new(&gpu.device, &descriptor).expect("a lamp");
    let ask = Ask::light(gpu, lamp.maps());
    let frame = OmniFrame {
        origin: DVec3::ZERO,
        light: OmniLight {
            position_world: light,
            range: 20.0,
        },
        camera: None,
        casters: &scene.list(),
        receivers: &everywhere,
    };
    record_omni(gpu, &mut lamp, &frame).expect("a frame");
    let all = |_: DVec3| true;
    let truth = settled(&scene.triangles, light, tangent, 6000, &mut random, all);
    count(&truth, &ask.points(gpu, &truth.points));
    for cone_degrees in [30.0, 90.0, 150.0_f64] {
        let descriptor = SpotShadowDescriptor {
            map_size,
            ..Default::default()
        };
        let mut spot = SpotShadow::new(&gpu.device, &descriptor).expect("a spot");
        let ask = Ask::light(gpu, spot.maps());
        for direction in [
            DVec3::Z,
            DVec3::new(-1.0, 0.3, 0.2),
            DVec3::new(0.3, -1.0, 0.4),
        ] {
            let half = 0.5 * cone_degrees.to_radians();
            let frame = SpotFrame {
                origin: DVec3::ZERO,
                light: SpotLight {
                    position_world: light,
                    direction: direction.as_vec3(),
                    outer_angle_radians: half as f32,
                    range: 20.0,
                },
                camera: None,
                casters: &scene.list(),
                receivers: &everywhere,
            };
            record_spot(gpu, &mut spot, &frame).expect("a frame");
            let axis = direction.normalize();
            let inside = |place: DVec3| (place - light).angle_between(axis) < half * 0.98;
            let tangent = tangent * half.tan().max(0.2) / half.cos().max(0.25);
            let truth = settled(&scene.triangles, light, tangent, 6000, &mut random, inside);
            count(&truth, &ask.points(gpu, &truth.points));
        }
    }
    assert_eq!(
        wrong,
        0,
        "of {dark} dark and {lit} lit on {}",
        gpu.describe()
    );
    assert!(dark > 1000 && lit > 1000, "{dark} dark, {lit} lit");
    table::record(
        "walls that pass beside spot and point lights, from behind to before",
        "settled receivers in the cone as the truth says",
        format!(
            "{wrong} wrong of {} settled receivers, {dark} of them dark",
            dark + lit
        ),
    );
}
