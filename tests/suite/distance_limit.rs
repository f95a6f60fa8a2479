//! Tests where shadows end: at a distance along the view or at the end of a light's range, at once
//! or over a fade.

use glam::{DVec3, Vec3};
use shadow_support::camera::Camera;
use shadow_support::mesh::Mesh;
use shadow_support::probe::Point;
use wgpu_shadows::{
    Aabb, CameraView, CascadeLayout, Casters, Coverage, DirectionalLight, DirectionalShadow,
    DirectionalShadowDescriptor, OmniLight, OmniShadow, OmniShadowDescriptor,
    ShadowFrameDescriptor, ShadowScene, Stability,
};

use crate::fixtures::ask::Ask;
use crate::fixtures::gpu::gpu;
use crate::fixtures::scene::Scene;

/// Returns a floor and a roof that covers all of it.
fn hall() -> Scene {
    let roof = Mesh::cuboid(Vec3::new(-300.0, 2.0, -300.0), Vec3::new(300.0, 2.5, 300.0));
    Scene::new(gpu(), &[Mesh::floor(0.0, 200.0), roof])
}

fn camera(side: f64) -> Camera {
    let eye = DVec3::new(side, 1.0, 0.0);
    Camera::modern(eye, eye + DVec3::new(0.0, -0.1, -1.0), 1.0, 1.5)
}

/// Records the hall for the cameras and returns the visibilities of `points`.
fn seen(
    descriptor: &DirectionalShadowDescriptor<'_>,
    cameras: &[CameraView],
    points: &[Point],
) -> Vec<f32> {
    let gpu = gpu();
    let hall = hall();
    let mut shadow = DirectionalShadow::new(&gpu.device, descriptor).expect("a valid sun");
    let ask = Ask::light(gpu, shadow.maps());
    let mut scene = ShadowScene::new();
    let list = hall.list();
    let frame = scene
        .frame(&ShadowFrameDescriptor {
            origin: DVec3::ZERO,
            coverage: Coverage::Cameras(cameras),
            casters: Casters::List(&list),
            receivers: &[],
        })
        .expect("a valid frame");
    let mut encoder = gpu.encoder();
    let light = DirectionalLight::new(Vec3::new(0.2, -1.0, 0.1));
    shadow
        .record(&mut encoder, &frame, &light)
        .expect("a valid frame");
    gpu.submit(encoder);
    ask.points(gpu, points)
}

/// Returns points of the floor that the camera sees, with their depths along its view.
fn positions(camera: &Camera) -> Vec<(f64, Point)> {
    let mut positions = Vec::new();
    for ahead in 3..110 {
        for aside in -4..=4 {
            let ahead = f64::from(ahead);
            let position = DVec3::new(f64::from(aside) * 0.08 * ahead, 0.0, -ahead);
            let position = position.as_vec3().as_dvec3();
            if camera.sees(position, f64::INFINITY, 0.001) {
                let forward = -camera.pose.axes.z_axis;
                let depth = forward.dot(position - camera.pose.eye);
                positions.push((depth, Point::rounded(position, DVec3::Y)));
            }
        }
    }
    positions
}

/// Checks that all receivers beyond the distance are lit, whatever the maps contain, and that all
/// before it are dark, in every way to fit the maps.
#[test]
fn shadows_end_at_the_distance() {
    const DISTANCE: f32 = 60.0;
    let camera = camera(0.0);
    let view = camera.view().with_max_distance(DISTANCE);
    let positions = positions(&camera);
    let points: Vec<_> = positions.iter().map(|(_, point)| *point).collect();
    for stability in [Stability::TightFit, Stability::BoundingSphere] {
        for (cascades, blend) in [(1, 0.0), (3, 0.0), (3, 0.2)] {
            let descriptor = DirectionalShadowDescriptor {
                map_size: 512,
                layout: CascadeLayout::fixed(cascades),
                blend,
                stability,
                ..Default::default()
            };
            let mut counts = [0, 0];
            for ((depth, _), seen) in positions.iter().zip(seen(&descriptor, &[view], &points)) {
                // The end is sharp to a ten-thousandth of the distance.
                if (depth - f64::from(DISTANCE)).abs() < 0.01 {
                    continue;
                }
                let lit = *depth > f64::from(DISTANCE);
                counts[usize::from(lit)] += 1;
                let wanted = if lit { 1.0 } else { 0.0 };
                assert_eq!(seen, wanted, "{stability:?} {cascades} {blend} at {depth}");
            }
            assert!(counts.iter().all(|count| *count > 50), "{counts:?}");
        }
    }
}

/// Checks that visibility grows in proportion to the depth over the fade.
#[test]
fn shadows_fade_before_the_distance() {
    let camera = camera(0.0);
    let view = camera.view().with_max_distance(60.0);
    let positions = positions(&camera);
    let points: Vec<_> = positions.iter().map(|(_, point)| *point).collect();
    let descriptor = DirectionalShadowDescriptor {
        map_size: 512,
        fade: 0.25,
        layout: CascadeLayout::fixed(1),
        ..Default::default()
    };
    let mut partial = 0;
    for ((depth, _), seen) in positions.iter().zip(seen(&descriptor, &[view], &points)) {
        let wanted = 1.0 - ((60.0 - depth) / 15.0).clamp(0.0, 1.0);
        // The weight is a sum of four products whose values are at most four, so that its error is
        // a few ulps of four.
        let error = (f64::from(seen) - wanted).abs();
        assert!(
            error < 32.0 * f64::from(f32::EPSILON),
            "{seen} for {wanted} at {depth}"
        );
        partial += usize::from(wanted > 0.0 && wanted < 1.0);
    }
    assert!(partial > 30, "{partial}");
}

/// Checks that two eyes share the farther end, and that cameras which look in different directions
/// have no common end and keep their shadows.
#[test]
fn several_cameras_share_an_end_if_they_look_the_same_way() {
    let [left, right] = [-0.03, 0.03].map(camera);
    let positions = positions(&left);
    let points: Vec<_> = positions.iter().map(|(_, point)| *point).collect();
    let descriptor = DirectionalShadowDescriptor {
        map_size: 512,
        layout: CascadeLayout::fixed(1),
        ..Default::default()
    };
    let limited = |camera: &Camera, distance| camera.view().with_max_distance(distance);
    let eyes = [limited(&left, 40.0), limited(&right, 50.0)];
    for ((depth, _), seen) in positions.iter().zip(seen(&descriptor, &eyes, &points)) {
        if *depth < 49.9 {
            assert_eq!(seen, 0.0, "{depth}");
        } else if *depth > 50.1 {
            assert_eq!(seen, 1.0, "{depth}");
        }
    }
    let eye = DVec3::new(0.0, 1.0, -70.0);
    let back = Camera::modern(eye, eye + DVec3::new(0.0, -0.1, 1.0), 1.0, 1.5);
    let apart = [limited(&left, 40.0), limited(&back, 40.0)];
    for ((depth, _), seen) in positions.iter().zip(seen(&descriptor, &apart, &points)) {
        // The other camera sees this up to 40 from its own eye.
        if (45.0..60.0).contains(depth) {
            assert_eq!(seen, 0.0, "{depth}");
        }
    }
}

/// Checks that the eyes of a headset whose displays are turned apart share an end wherever the
/// cameras are.
#[test]
fn eyes_that_are_turned_apart_share_an_end_anywhere() {
    let descriptor = DirectionalShadowDescriptor {
        map_size: 512,
        layout: CascadeLayout::fixed(1),
        ..Default::default()
    };
    for aside in [0.0, 150.0] {
        let first = camera(aside);
        let eye = first.pose.eye;
        let turned = Camera::modern(eye, eye + DVec3::new(0.3, -0.1, -1.0), 1.0, 1.5);
        let eyes = [&first, &turned].map(|camera| camera.view().with_max_distance(40.0));
        let in_view = |depth: f64| {
            let middle = DVec3::new(0.05, 0.0, -1.0) * depth;
            let position = DVec3::new(eye.x, 0.0, eye.z) + middle;
            (
                -first.pose.axes.z_axis.dot(position - eye),
                Point::rounded(position, DVec3::Y),
            )
        };
        let depths = (50..800).map(|depth| f64::from(depth) * 0.1);
        let positions: Vec<_> = depths.map(in_view).collect();
        let points: Vec<_> = positions.iter().map(|(_, point)| *point).collect();
        for ((depth, _), seen) in positions.iter().zip(seen(&descriptor, &eyes, &points)) {
            if (depth - 40.0).abs() > 0.1 {
                let wanted = if *depth > 40.0 { 1.0 } else { 0.0 };
                assert_eq!(seen, wanted, "{aside}: {depth}");
            }
        }
    }
}

/// Checks that shadows end at the sides of a covered box as seen from the light, or up to a texel
/// beyond, wherever the box is, while the map itself reaches farther.
#[test]
fn shadows_end_at_a_covered_box() {
    let gpu = gpu();
    let hall = hall();
    let list = hall.list();
    let light = DirectionalLight::new(Vec3::new(0.2, -1.0, 0.1));
    let descriptor = DirectionalShadowDescriptor {
        map_size: 256,
        layout: CascadeLayout::fixed(1),
        ..Default::default()
    };
    let mut shadow = DirectionalShadow::new(&gpu.device, &descriptor).expect("a valid sun");
    let ask = Ask::light(gpu, shadow.maps());
    let mut reached = 0.0_f64;
    for step in 0..40 {
        let middle = DVec3::new(0.31 * f64::from(step), 0.0, -0.17 * f64::from(step));
        let half = DVec3::new(10.0, 0.5, 8.0);
        let (low, high) = ((middle - half).as_vec3(), (middle + half).as_vec3());
        let mut scene = ShadowScene::new();
        let frame = scene
            .frame(&ShadowFrameDescriptor {
                origin: DVec3::ZERO,
                coverage: Coverage::Bounds(Aabb::new(low, high)),
                casters: Casters::List(&list),
                receivers: &[],
            })
            .expect("a valid frame");
        let mut encoder = gpu.encoder();
        shadow
            .record(&mut encoder, &frame, &light)
            .expect("a valid frame");
        gpu.submit(encoder);
        let view = shadow.maps().views().next().expect("a view");
        let (texel, matrix) = (view.texel_size_world(), view.clip_from_render());
        // The map's axes are found from its matrix.
        let axis = |row: usize| matrix.row(row).truncate().as_dvec3().normalize();
        let axes = [(axis(0), f64::from(texel.x)), (axis(1), f64::from(texel.y))];
        let steps = || (-60..=60).map(|step| f64::from(step) * 0.25);
        let floor = steps().flat_map(|x| steps().map(move |z| DVec3::new(x, 0.0, z)));
        let floor: Vec<_> = floor
            .map(|from_middle| (middle + from_middle).as_vec3().as_dvec3())
            .collect();
        let points: Vec<_> = floor
            .iter()
            .map(|position| Point::rounded(*position, DVec3::Y))
            .collect();
        for (position, seen) in floor.iter().zip(ask.points(gpu, &points)) {
            let from_middle = *position - middle;
            // This is how many texels the position is outside the box, seen from the light.
            let outside = axes
                .map(|(axis, texel)| (axis.dot(from_middle).abs() - axis.abs().dot(half)) / texel);
            let outside = outside[0].max(outside[1]);
            // Positions and box are rounded by far less than a hundredth of a texel.
            if outside < 0.99 {
                assert_eq!(seen, 0.0, "{step}: {position} is {outside} texels outside");
                reached = reached.max(outside);
            } else if outside > 1.01 {
                assert_eq!(seen, 1.0, "{step}: {position} is {outside} texels outside");
            }
        }
    }
    assert!(reached > 0.5, "{reached}");
}

/// Checks that a lamp's shadows fade toward the end of its range.
#[test]
fn a_lamps_shadows_fade_before_its_range() {
    let gpu = gpu();
    let descriptor = OmniShadowDescriptor {
        map_size: 256,
        fade: 0.5,
        ..Default::default()
    };
    let mut lamp = OmniShadow::new(&gpu.device, &descriptor).expect("a valid lamp");
    let ask = Ask::light(gpu, lamp.maps());
    let shade = Mesh::cuboid(Vec3::new(-2.0, 1.0, -2.0), Vec3::new(2.0, 1.2, 2.0));
    let parts = Scene::new(gpu, &[shade, Mesh::floor(-12.0, 40.0)]);
    let list = parts.list();
    let mut scene = ShadowScene::new();
    let frame = scene
        .frame(&ShadowFrameDescriptor {
            origin: DVec3::ZERO,
            coverage: Coverage::Everything,
            casters: Casters::List(&list),
            receivers: &[Aabb::new(Vec3::splat(-30.0), Vec3::splat(30.0))],
        })
        .expect("a valid frame");
    let light = OmniLight {
        position_world: DVec3::new(0.0, 2.0, 0.0),
        range: 20.0,
    };
    let mut encoder = gpu.encoder();
    lamp.record(&mut encoder, &frame, &light)
        .expect("a valid frame");
    gpu.submit(encoder);
    let distances: Vec<f32> = (4..24).map(|step| step as f32 + 0.25).collect();
    let points: Vec<_> = distances
        .iter()
        .map(|distance| Point::new(Vec3::new(0.0, 2.0 - distance, 0.0), Vec3::Y))
        .collect();
    for (distance, seen) in distances.iter().zip(ask.points(gpu, &points)) {
        let wanted = 1.0 - ((20.0 - distance) / 10.0).clamp(0.0, 1.0);
        assert!(
            (seen - wanted).abs() < 32.0 * f32::EPSILON,
            "{seen} for {wanted} at {distance}"
        );
    }
}
