//! Tests bad and unusual input of point lights: it is refused with field and value, or every result
//! is a visibility.

use glam::{DVec3, Vec3};
use shadow_support::mesh::Mesh;
use shadow_support::probe::Point;
use shadow_support::random::Random;
use wgpu_shadows::{
    Aabb, Filter, OmniLight, OmniShadow, OmniShadowDescriptor, ShadowError, report::ViewStatus,
};

use crate::fixtures::ask::{Ask, record_omni};
use crate::fixtures::frames::OmniFrame;
use crate::fixtures::gpu::gpu;
use crate::fixtures::scene::Scene;
use crate::fixtures::table;

const EVERYWHERE: [Aabb; 1] = [Aabb::new(Vec3::splat(-40.0), Vec3::splat(40.0))];

fn lamp(map_size: u32) -> Result<OmniShadow, ShadowError> {
    let descriptor = OmniShadowDescriptor {
        map_size,
        ..Default::default()
    };
    OmniShadow::new(&gpu().device, &descriptor)
}

fn scene() -> Scene {
    Scene::new(
        gpu(),
        &[
            Mesh::floor(-1.0, 8.0),
            Mesh::cuboid(Vec3::new(1.0, -0.5, -0.5), Vec3::new(2.0, 0.5, 0.5)),
        ],
    )
}

#[test]
fn sizes_that_no_map_has() {
    let most = gpu().device.limits().max_texture_dimension_2d;
    let field = "OmniShadowDescriptor::map_size";
    let zero = ShadowError::OutOfRange {
        field,
        rule: "at least 1",
        value: "0".to_owned(),
    };
    assert_eq!(lamp(0).expect_err("no texels"), zero);
    let large = ShadowError::OverDeviceLimit {
        field,
        limit: "max_texture_dimension_2d",
        maximum: most.into(),
        value: u64::from(most) + 1,
    };
    assert_eq!(lamp(most + 1).expect_err("too large"), large);
    lamp(1).expect("one texel is a map");
}

#[test]
fn radii_that_no_filter_has() {
    for radius in [0.0, -1.0, f32::NAN, f32::INFINITY] {
        for filter in [
            Filter::DirectionGrid { radius },
            Filter::DirectionStar { radius },
        ] {
            let descriptor = OmniShadowDescriptor {
                map_size: 8,
                filter,
                ..Default::default()
            };
            let wanted = ShadowError::OutOfRange {
                field: "OmniShadowDescriptor::filter",
                rule: "a filter with a finite radius above 0",
                value: radius.to_string(),
            };
            let refused = OmniShadow::new(&gpu().device, &descriptor);
            assert_eq!(refused.expect_err("no radius"), wanted);
        }
    }
}

/// Each bad frame is refused by name, and leaves the maps, the report and the visibilities of the
/// last valid one.
#[test]
fn frames_that_are_refused_change_nothing() {
    let gpu = gpu();
    let scene = scene();
    let list = scene.list();
    let mut shadow = lamp(64).expect("a valid lamp");
    let ask = Ask::light(gpu, shadow.maps());
    let good = OmniFrame {
        origin: DVec3::ZERO,
        light: OmniLight {
            position_world: DVec3::ZERO,
            range: 20.0,
        },
        camera: None,
        casters: &list,
        receivers: &EVERYWHERE,
    };
    record_omni(gpu, &mut shadow, &good).expect("a good frame");
    let points = [
        Point::new(Vec3::new(4.0, 0.0, 0.0), Vec3::NEG_X),
        Point::new(Vec3::new(0.0, -1.0, 2.0), Vec3::Y),
    ];
    assert_eq!(ask.points(gpu, &points), [0.0, 1.0]);
    let at = |position_world| OmniFrame {
        light: OmniLight {
            position_world,
            ..good.light
        },
        ..good
    };
    let reaching = |range| OmniFrame {
        light: OmniLight {
            range,
            ..good.light
        },
        ..good
    };
    let not_finite = |field, value: &str| ShadowError::NotFinite {
        field,
        value: value.to_owned(),
    };
    let range = |value: &str| ShadowError::OutOfRange {
        field: "OmniLight::range",
        rule: "above 0 (infinity allowed)",
        value: value.to_owned(),
    };
    let position = "OmniLight::position_world";
    let cases = [
        (
            at(DVec3::new(f64::NAN, 1.0, 2.0)),
            not_finite(position, "[NaN, 1, 2]"),
        ),
        (
            at(DVec3::new(1.0, f64::INFINITY, 2.0)),
            not_finite(position, "[1, inf, 2]"),
        ),
        (
            OmniFrame {
                origin: DVec3::NAN,
                ..good
            },
            not_finite("ShadowFrameDescriptor::origin", "[NaN, NaN, NaN]"),
        ),
        (reaching(0.0), range("0")),
        (reaching(-2.5), range("-2.5")),
        (reaching(f32::NAN), range("NaN")),
    ];
    for (frame, wanted) in cases {
        let before = (
            shadow.maps().report().clone(),
            shadow.maps().view_uniforms().to_vec(),
        );
        let error = record_omni(gpu, &mut shadow, &frame).expect_err("a bad frame");
        assert_eq!(error, wanted);
        assert_eq!(
            before,
            (
                shadow.maps().report().clone(),
                shadow.maps().view_uniforms().to_vec()
            )
        );
        assert_eq!(ask.points(gpu, &points), [0.0, 1.0]);
        // The maps are still known to be valid: the same valid frame again takes no pass.
        let again = record_omni(gpu, &mut shadow, &good).expect("a good frame");
        assert_eq!(again.passes, 0, "{error}");
    }
}

/// Lights at unusual positions and of unusual reach are refused with an error, or every result is a
/// visibility. They are on a vertex, on a surface, on an edge, inside a solid, near zero and near
/// infinity.
#[test]
fn odd_lights_get_visibilities() {
    let gpu = gpu();
    let scene = scene();
    let list = scene.list();
    let mut random = Random::new(53);
    let mut points: Vec<_> = (0..400)
        .map(|index| {
            let triangle = scene.triangles[index % scene.triangles.len()];
            let place = triangle.point(random.unit(), random.unit());
            Point::rounded(place, triangle.normal())
        })
        .collect();
    // These are the corners themselves, so that a receiver lies exactly at the light.
    let corners = scene.triangles.iter().flat_map(|triangle| triangle.0);
    points.extend(corners.map(|corner| Point::rounded(corner, DVec3::Y)));
    let places = [
        DVec3::new(1.0, -0.5, -0.5),
        DVec3::new(1.5, 0.5, 0.0),
        DVec3::new(1.5, 0.5, 0.5),
        DVec3::new(1.5, 0.0, 0.0),
        DVec3::new(0.0, -1.0, 0.0),
        DVec3::new(0.0, -1.0 + 1e-9, 0.0),
        DVec3::splat(1e6),
        DVec3::splat(1e19),
        DVec3::splat(1e30),
        DVec3::splat(1e300),
    ];
    let ranges = [
        f32::MIN_POSITIVE,
        1e-30,
        1e-3,
        5.0,
        1e9,
        f32::MAX,
        f32::INFINITY,
    ];
    let (mut refused, mut dark) = (0, 0);
    for filter in [
        Filter::default(),
        Filter::Hardware,
        Filter::Pcss { light_size: 0.1 },
        Filter::DirectionStar { radius: 0.05 },
    ] {
        let descriptor = OmniShadowDescriptor {
            map_size: 32,
            filter,
            ..Default::default()
        };
        let mut shadow = OmniShadow::new(&gpu.device, &descriptor).expect("a valid lamp");
        let ask = Ask::light(gpu, shadow.maps());
        for position_world in places {
            for range in ranges {
                let frame = OmniFrame {
                    origin: DVec3::ZERO,
                    light: OmniLight {
                        position_world,
                        range,
                    },
                    camera: None,
                    casters: &list,
                    receivers: &[],
                };
                match record_omni(gpu, &mut shadow, &frame) {
                    Ok(_) => {}
                    Err(ShadowError::ViewNotRepresentable { .. }) => refused += 1,
                    Err(error) => panic!("{position_world} {range}: {error}"),
                }
                for (point, seen) in points.iter().zip(ask.points(gpu, &points)) {
                    let place = format!("{filter:?} {position_world} {range} {point:?}");
                    assert!((0.0..=1.0).contains(&seen), "{place}: {seen}");
                    dark += usize::from(seen < 0.5);
                }
            }
        }
    }
    assert!(refused > 0 && dark > 1000, "{refused} refused, {dark} dark");
    table::record(
        "point lights on vertices, edges, surfaces and in solids, at up to 1e300, ranges of 1e-38 to infinity",
        "answers in 0..=1, or a view that f32 cannot hold is refused",
        format!(
            "{refused} refused of {}, 0 broken",
            4 * places.len() * ranges.len()
        ),
    );
}

/// A light on the floor shines over it, and one on a face of a box leaves the other sides of the
/// box dark.
#[test]
fn lights_on_surfaces() {
    let gpu = gpu();
    let scene = scene();
    let mut shadow = lamp(256).expect("a valid lamp");
    let ask = Ask::light(gpu, shadow.maps());
    let frame = OmniFrame {
        origin: DVec3::ZERO,
        light: OmniLight {
            position_world: DVec3::new(1.0, 0.0, 0.0),
            range: 30.0,
        },
        camera: None,
        casters: &scene.list(),
        receivers: &EVERYWHERE,
    };
    let report = record_omni(gpu, &mut shadow, &frame).expect("a good frame");
    assert!(
        report
            .views
            .iter()
            .any(|view| view.status == ViewStatus::Drawn)
    );
    let floor = |x, z| Point::new(Vec3::new(x, -1.0, z), Vec3::Y);
    // On the side to which the light shines, receivers are lit. Behind the box they are dark: the
    // face on which the light lies cannot cast, but the face opposite to it does.
    let points = [floor(-2.0, 0.3), floor(0.2, -3.0), floor(4.0, 0.0)];
    assert_eq!(ask.points(gpu, &points), [1.0, 1.0, 0.0]);
}
