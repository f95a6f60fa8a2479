//! Tests bounds without volume or without limit, lights without direction, and maps of every size.

use glam::{DVec3, Mat4, Vec3};
use shadow_support::camera::Camera;
use shadow_support::mesh::Mesh;
use shadow_support::probe::Point;
use wgpu_shadows::{
    Aabb, CascadeLayout, DirectionalLight, DirectionalShadow, DirectionalShadowDescriptor,
    ShadowError, report::ViewStatus,
};

use super::stage::{Sun, caster};
use super::table;
use crate::fixtures::frames::{Coverage, DirectionalFrame, RecordFrame};
use crate::fixtures::gpu::gpu;
use crate::fixtures::watched::Watched;

fn cover() -> Aabb {
    Aabb::new(Vec3::new(-2.0, -0.5, -2.0), Vec3::new(2.0, 1.5, 2.0))
}

/// Returns a flat plate at height one over the middle.
fn plate() -> Mesh {
    Mesh::sheet(Vec3::new(-1.0, 1.0, -1.0), Vec3::Z * 2.0, Vec3::X * 2.0)
}

fn below() -> [Point; 2] {
    [
        Point::new(Vec3::new(0.1, 0.0, 0.1), Vec3::Y),
        Point::new(Vec3::new(1.9, 0.0, 1.9), Vec3::Y),
    ]
}

/// Returns the visibilities of the position below the plate and of one beside it, or the frame's
/// error.
fn frame(
    sun: &mut Sun,
    light: Vec3,
    coverage: Coverage,
    bounds: Aabb,
    receivers: &[Aabb],
) -> Result<(ViewStatus, Vec<f32>), ShadowError> {
    let gpu = gpu();
    let plate = Watched::with_bounds(caster(gpu, &plate(), Mat4::IDENTITY), bounds);
    let frame = DirectionalFrame {
        origin: DVec3::ZERO,
        light: DirectionalLight::new(light),
        coverage,
        casters: &[&plate],
        receivers,
    };
    let mut encoder = gpu.encoder();
    let result = sun.shadow.record_frame(&mut encoder, &frame);
    let status = result.map(|report| report.views[0].status);
    gpu.submit(encoder);
    status.map(|status| (status, sun.ask(&below())))
}

/// Bounds of a sheet are flat and cast all the same; bounds that are a point, or empty, may cast
/// nothing and break nothing; bounds that are not finite are refused by name.
#[test]
fn bounds_without_volume_or_without_end() {
    let mut sun = Sun::of_size(128);
    let camera = Camera::modern(DVec3::new(4.0, 5.0, 6.0), DVec3::ZERO, 1.0, 1.0).view();
    let floor = [Mesh::floor(0.0, 2.0).bounds()];
    let coverages = [
        Coverage::Bounds(cover()),
        Coverage::Camera(camera),
        Coverage::Camera(camera.with_max_distance(30.0)),
    ];
    let down = Vec3::NEG_Y;
    for coverage in coverages {
        let flat = plate().bounds();
        let seen = frame(&mut sun, down, coverage, flat, &floor).expect("flat bounds");
        assert_eq!(seen, (ViewStatus::Drawn, vec![0.0, 1.0]), "{coverage:?}");
        let soft = [
            Aabb::EMPTY,
            Aabb::new(Vec3::splat(0.3), Vec3::splat(0.3)),
            Aabb::new(Vec3::INFINITY, Vec3::NEG_INFINITY),
            Aabb::new(Vec3::splat(-1e15), Vec3::splat(1e15)),
        ];
        for bounds in soft {
            let (_, seen) = frame(&mut sun, down, coverage, bounds, &floor).expect("bounds");
            assert!(seen.iter().all(|seen| (0.0..=1.0).contains(seen)));
        }
        let nan = Vec3::new(0.0, f32::NAN, 0.0);
        let endless = [
            Aabb::new(nan, Vec3::ONE),
            Aabb::new(Vec3::NEG_ONE, nan),
            Aabb::new(Vec3::NEG_INFINITY, Vec3::INFINITY),
            Aabb::new(Vec3::ZERO, Vec3::INFINITY),
        ];
        for bounds in endless {
            // A broken caster casts nothing, and a broken receiver costs nothing.
            let as_caster = frame(&mut sun, down, coverage, bounds, &floor).expect("left out");
            assert_eq!(as_caster, (ViewStatus::Empty, vec![1.0, 1.0]), "{bounds:?}");
            let with_floor = [bounds, floor[0]];
            let as_receiver = frame(&mut sun, down, coverage, flat, &with_floor).expect("left out");
            assert_eq!(as_receiver.1, [0.0, 1.0], "{bounds:?}");
        }
        // For the largest numbers that exist, the fit can be represented, or an error says that it
        // cannot.
        let huge = Aabb::new(Vec3::splat(-f32::MAX), Vec3::splat(f32::MAX));
        match frame(&mut sun, down, coverage, huge, &floor) {
            Ok((_, seen)) => assert!(seen.iter().all(|seen| (0.0..=1.0).contains(seen))),
            Err(error) => assert!(
                matches!(error, ShadowError::ViewNotRepresentable { .. }),
                "{error:?}"
            ),
        }
    }
    // A covered box that is a plane or a point is padded; an empty one covers nothing.
    let at = |low: Vec3, high: Vec3| Coverage::Bounds(Aabb::new(low, high));
    let plane = at(Vec3::new(-2.0, 0.0, -2.0), Vec3::new(2.0, 0.0, 2.0));
    let flat = plate().bounds();
    let (_, seen) = frame(&mut sun, down, plane, flat, &floor).expect("a plane");
    assert_eq!(seen[0], 0.0);
    let point = at(Vec3::new(0.1, 0.0, 0.1), Vec3::new(0.1, 0.0, 0.1));
    let (_, seen) = frame(&mut sun, down, point, flat, &floor).expect("a point");
    assert_eq!(seen[0], 0.0, "below the plate, at the covered point");
    let nothing = Coverage::Bounds(Aabb::EMPTY);
    let (status, seen) = frame(&mut sun, down, nothing, flat, &floor).expect("nothing");
    assert_eq!((status, seen), (ViewStatus::Empty, vec![1.0, 1.0]));
    table::record(
        "flat, point, empty and endless bounds",
        "flat bounds cast, empty ones are passed over, endless ones are left out",
        "as expected, by box and by camera",
    );
}

/// Length has no meaning: a direction of the smallest or largest numbers shines as its unit vector
/// does, to the bit where it points along an axis. Zero and non-finite directions are refused, and
/// the last visibilities stay.
#[test]
fn lights_without_length_or_direction() {
    let mut sun = Sun::of_size(128);
    let coverage = Coverage::Bounds(cover());
    let bounds = plate().bounds();
    let mut look = |light: Vec3| frame(&mut sun, light, coverage, bounds, &[]);
    let unit = look(Vec3::new(0.0, -1.0, 0.0)).expect("a light").1;
    assert_eq!(unit, [0.0, 1.0]);
    for length in [f32::MAX, 1e30, 1e-30, f32::MIN_POSITIVE, 1e-45] {
        let straight = look(Vec3::NEG_Y * length).expect("a light");
        assert_eq!(straight.1, unit, "{length}");
        let oblique = Vec3::new(0.0, -1.0, 1.0) * length;
        assert_eq!(look(oblique).expect("a light").1[1], 1.0, "{length}");
    }
    assert!(matches!(
        look(Vec3::ZERO),
        Err(ShadowError::ZeroDirection { .. })
    ));
    for broken in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
        let result = look(Vec3::new(0.0, broken, 0.0));
        assert!(
            matches!(result, Err(ShadowError::NotFinite { .. })),
            "{broken}: {result:?}"
        );
    }
    table::record(
        "directions of length 1e-45 to f32::MAX, zero and broken ones",
        "as the unit vector, or refused",
        "as expected",
    );
}

/// Maps range from a single texel to the largest that every device supports: the plate's shadow is
/// there wherever there are texels for it, nothing shadows itself in any, and impossible sizes are
/// refused by name.
#[test]
fn maps_of_every_size() {
    let gpu = gpu();
    let new = |map_size| {
        let descriptor = DirectionalShadowDescriptor {
            map_size,
            layout: CascadeLayout::fixed(1),
            ..Default::default()
        };
        DirectionalShadow::new(&gpu.device, &descriptor)
    };
    let largest = gpu.device.limits().max_texture_dimension_2d;
    for map_size in [1, 2, 3, 7, 8, 33, 1000, largest] {
        let mut sun = Sun::of_size(map_size);
        let coverage = Coverage::Bounds(cover());
        let (status, seen) =
            frame(&mut sun, Vec3::NEG_Y, coverage, plate().bounds(), &[]).expect("a frame");
        assert_eq!(status, ViewStatus::Drawn, "{map_size}");
        assert!(seen.iter().all(|seen| (0.0..=1.0).contains(seen)));
        if map_size >= 33 {
            assert_eq!(seen, [0.0, 1.0], "{map_size}");
        }
        // This is the plate's own lit side.
        let on_plate: Vec<_> = (0..100)
            .map(|index| {
                let (x, z) = ((index % 10) as f32 * 0.19, (index / 10) as f32 * 0.19);
                Point::new(Vec3::new(x - 0.93, 1.0, z - 0.93), Vec3::Y)
            })
            .collect();
        let seen = sun.ask(&on_plate);
        assert!(seen.iter().all(|seen| *seen > 1.0 - 1e-4), "{map_size}");
    }
    let zero = new(0).expect_err("no map");
    assert!(matches!(zero, ShadowError::OutOfRange { .. }), "{zero:?}");
    let over = new(largest + 1).expect_err("too large");
    assert!(
        matches!(over, ShadowError::OverDeviceLimit { value, maximum, .. } if value == u64::from(largest) + 1 && maximum == u64::from(largest)),
        "{over:?}"
    );
    table::record(
        "maps of 1, 2, 3, 7, 8, 33, 1000 and 8192 texels a side, of none and of 8193",
        "nothing shadows itself, shadows from 33 texels on, the last two refused",
        "as expected",
    );
}
