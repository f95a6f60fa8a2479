//! Tests point lights: the shadows are where a ray caster has them, and the faces cost no more than
//! they must.

use glam::{DVec3, Vec3};
use shadow_support::camera::Camera;
use shadow_support::mesh::Mesh;
use shadow_support::probe::Point;
use shadow_support::random::Random;
use wgpu_shadows::{
    Aabb, Bias, CameraView, Filter, OmniLight, OmniShadow, OmniShadowDescriptor,
    report::ShadowReport, report::ViewStatus,
};

use crate::fixtures::ask::{Ask, record_omni};
use crate::fixtures::frames::OmniFrame;
use crate::fixtures::gpu::{Gpu, gpu};
use crate::fixtures::local_truth::settled;
use crate::fixtures::scene::Scene;

/// Makes all of space receive, so that every caster is drawn, including a flat wall with nothing
/// behind it.
pub(super) const EVERYWHERE: [Aabb; 1] = [Aabb::new(Vec3::splat(-40.0), Vec3::splat(40.0))];

/// Holds a light and the probe that samples it.
pub(super) struct Lamp {
    pub shadow: OmniShadow,
    pub ask: Ask,
    pub name: String,
}

impl Lamp {
    pub fn new(gpu: &Gpu, map_size: u32, filter: Filter, bias: Bias) -> Self {
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

    pub fn record(
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
