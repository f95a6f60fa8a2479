//! Tests bad input of spot lights: it is refused with field and value, and nothing changes.

use glam::{DVec3, Vec3};
use shadow_support::mesh::Mesh;
use wgpu_shadows::{Aabb, Filter, ShadowError, SpotLight, SpotShadow, SpotShadowDescriptor};

use crate::fixtures::ask::record_spot;
use crate::fixtures::frames::SpotFrame;
use crate::fixtures::gpu::gpu;
use crate::fixtures::scene::Scene;

const EVERYWHERE: [Aabb; 1] = [Aabb::new(Vec3::splat(-60.0), Vec3::splat(60.0))];

#[test]
fn bad_spots_are_refused() {
    let gpu = gpu();
    let scene = Scene::new(gpu, &[Mesh::floor(0.0, 2.0)]);
    let list = scene.list();
    let descriptor = SpotShadowDescriptor {
        map_size: 32,
        ..Default::default()
    };
    let mut shadow = SpotShadow::new(&gpu.device, &descriptor).expect("a valid spot");
    let good = SpotLight {
        position_world: DVec3::Y,
        direction: Vec3::NEG_Y,
        outer_angle_radians: 0.5,
        range: 9.0,
    };
    let frame = |light| SpotFrame {
        origin: DVec3::ZERO,
        light,
        camera: None,
        casters: &list,
        receivers: &EVERYWHERE,
    };
    record_spot(gpu, &mut shadow, &frame(good)).expect("a good frame");
    let before = shadow.maps().report().clone();
    let angle = |outer_angle_radians: f32, value: &str| {
        let light = SpotLight {
            outer_angle_radians,
            ..good
        };
        let error = ShadowError::OutOfRange {
            field: "SpotLight::outer_angle_radians",
            rule: "above 0 and below π/2",
            value: value.to_owned(),
        };
        (light, error)
    };
    let toward = |direction: Vec3| SpotLight { direction, ..good };
    let field = "SpotLight::direction";
    let half_turn = std::f32::consts::FRAC_PI_2;
    let cases = [
        angle(0.0, "0"),
        angle(-0.5, "-0.5"),
        angle(f32::NAN, "NaN"),
        angle(half_turn, &half_turn.to_string()),
        (toward(Vec3::ZERO), ShadowError::ZeroDirection { field }),
        (
            toward(Vec3::new(0.0, f32::NAN, 1.0)),
            ShadowError::NotFinite {
                field,
                value: "[0, NaN, 1]".to_owned(),
            },
        ),
        (
            SpotLight { range: 0.0, ..good },
            ShadowError::OutOfRange {
                field: "SpotLight::range",
                rule: "above 0 (infinity allowed)",
                value: "0".to_owned(),
            },
        ),
        (
            SpotLight {
                position_world: DVec3::new(0.0, f64::INFINITY, 0.0),
                ..good
            },
            ShadowError::NotFinite {
                field: "SpotLight::position_world",
                value: "[0, inf, 0]".to_owned(),
            },
        ),
    ];
    for (light, wanted) in cases {
        let error = record_spot(gpu, &mut shadow, &frame(light)).expect_err("a bad light");
        assert_eq!(error, wanted);
        assert_eq!(&before, shadow.maps().report(), "{error}");
    }
    let descriptor = SpotShadowDescriptor {
        filter: Filter::DirectionGrid { radius: 0.1 },
        ..Default::default()
    };
    let refused = SpotShadow::new(&gpu.device, &descriptor).expect_err("a filter of cubes");
    assert!(matches!(
        refused,
        ShadowError::OutOfRange {
            field: "SpotShadowDescriptor::filter",
            ..
        }
    ));
}
