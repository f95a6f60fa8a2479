//! Tests what the report says about a cascade's slice: how much of the map falls on it, and how
//! finely.

use glam::{DVec3, Vec3};
use shadow_support::camera::{Camera, Lens};
use shadow_support::mesh::Mesh;
use shadow_support::random::Random;
use wgpu_shadows::{
    CascadeLayout, DirectionalLight, DirectionalShadow, DirectionalShadowDescriptor, Stability,
    report::ShadowReport,
};

use crate::fixtures::frames::{Coverage, DirectionalFrame};
use crate::fixtures::gpu::gpu;
use crate::fixtures::probe::record;
use crate::fixtures::scene::Scene;
use crate::fixtures::town::{TOWN_SUN, town};

fn report(
    scene: &Scene,
    camera: &Camera,
    light: Vec3,
    descriptor: &DirectionalShadowDescriptor<'_>,
) -> ShadowReport {
    let mut shadow = DirectionalShadow::new(&gpu().device, descriptor).expect("a valid sun");
    let frame = DirectionalFrame {
        origin: DVec3::ZERO,
        light: DirectionalLight::new(light),
        coverage: Coverage::Camera(camera.view().with_max_distance(200.0)),
        casters: &scene.list(),
        receivers: &[],
    };
    record(gpu(), &mut shadow, &frame)
}

/// For an orthographic image of 6 by 4 from straight above, with the light along the view, the
/// slice's footprint is the image, and a texel is as large on it as on the map. f32 rounds the
/// report (2^-24 of it), and the camera's matrix by its 2^-24 of the distance of 30.
#[test]
fn a_picture_from_the_light_is_its_own_footprint() {
    let scene = Scene::new(
        gpu(),
        &[
            Mesh::cuboid(Vec3::new(-9.0, 1.0, -9.0), Vec3::new(9.0, 2.0, 9.0)),
            Mesh::floor(0.0, 20.0),
        ],
    );
    let mut camera = Camera::modern(
        DVec3::new(0.2, 30.0, 0.3),
        DVec3::new(0.2, 0.0, 0.299),
        1.0,
        1.5,
    );
    camera.lens = Lens::Orthographic {
        sides: [-3.0, 3.0, -2.0, 2.0],
        near: 0.0,
        far: 100.0,
    };
    camera.pose.axes = glam::DMat3::from_cols(DVec3::X, DVec3::NEG_Z, DVec3::Y);
    let report = report(
        &scene,
        &camera,
        Vec3::NEG_Y,
        &DirectionalShadowDescriptor {
            map_size: 256,
            layout: CascadeLayout::fixed(1),
            ..Default::default()
        },
    );
    let view = &report.views[0];
    let slice = view.slice.expect("a camera's slice");
    let map = view.texel_size_world * 256.0;
    let wanted = 6.0 * 4.0 / (map.x * map.y);
    assert!(
        (slice.map_utilization - wanted).abs() < 1e-5,
        "{slice:?} {wanted}"
    );
    let texels = 4.0 / view.texel_size_world;
    let across = slice.texels_across_image;
    assert!(
        (across.x - texels.min_element()).abs() < 1e-3,
        "{across} {texels}"
    );
    assert!(
        (across.y - texels.max_element()).abs() < 1e-3,
        "{across} {texels}"
    );
    assert_eq!(slice.texels_per_pixel(512), across / 512.0);
    // The slab's top, two above the floor, is the nearest surface that is seen, and the floor is
    // the farthest.
    assert!((slice.depth_near - 28.0).abs() < 1e-4 && (slice.depth_far - 30.0).abs() < 1e-4);
}

/// Through a town, at least half of the texels of the fitted maps fall on their slices, on average
/// over positions and cascades, and a sphere around each slice leaves less than half of that.
#[test]
fn fitted_maps_waste_less_than_half() {
    let mut random = Random::new(41);
    let scene = Scene::new(gpu(), &town(41));
    let mut shares = [0.0_f32; 2];
    let mut count = 0;
    for _ in 0..20 {
        let eye = random.point(DVec3::new(-60.0, 1.7, -60.0), DVec3::new(60.0, 1.7, 60.0));
        let way = random.direction().with_y(-0.05);
        let camera = Camera::modern(eye, eye + way, 1.0, 16.0 / 9.0);
        let both = [Stability::TightFit, Stability::BoundingSphere].map(|stability| {
            report(
                &scene,
                &camera,
                TOWN_SUN,
                &DirectionalShadowDescriptor {
                    map_size: 256,
                    layout: CascadeLayout::fixed(4),
                    stability,
                    ..Default::default()
                },
            )
        });
        for (fitted, sphere) in both[0].views.iter().zip(&both[1].views) {
            if let (Some(fitted), Some(sphere)) = (fitted.slice, sphere.slice) {
                shares[0] += fitted.map_utilization;
                shares[1] += sphere.map_utilization;
                count += 1;
            }
        }
    }
    assert!(count >= 40, "{count} cascades");
    let [fitted, sphere] = shares.map(|share| share / count as f32);
    assert!(fitted >= 0.5 && sphere <= 0.25, "{fitted} {sphere}");
}
