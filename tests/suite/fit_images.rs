//! Tests everything from random cameras and boxes to visibilities: the fit must show every shadow
//! that can be seen, and must not depend on where the world's origin is or in what unit the world
//! is measured.
//!
//! Seeds are fixed; `PROPTEST_RNG_SEED` and `PROPTEST_CASES` explore further.

use std::cell::Cell;

use glam::DVec3;
use proptest::prelude::*;
use proptest::test_runner::{Config, RngSeed, TestRunner};
use shadow_support::camera::{Camera, Lens, Pose};
use shadow_support::probe::Point;
use shadow_support::triangle::occluded;
use wgpu_shadows::reference::receiver;
use wgpu_shadows::{Aabb, Bias, Filter};

use crate::fixtures::frames::Coverage;
use crate::fixtures::gpu::gpu;
use crate::fixtures::probe::SunProbe;
use crate::fixtures::random_scene::{Placed, World, world};
use crate::fixtures::rounding::band;
use crate::fixtures::table;
use crate::fixtures::view_member::member;

const MAP_SIZE: u32 = 192;
/// Is the default filter.
const FILTER: Filter = Filter::Tent3 { sharpness: 3.0 };

/// Runs `test` on that many cases, and fails with the smallest failure that proptest finds.
fn run<S: Strategy>(cases: u32, strategy: S, test: impl Fn(S::Value) -> Result<(), TestCaseError>) {
    let mut config = Config {
        failure_persistence: None,
        ..Config::default()
    };
    if config.rng_seed == RngSeed::Random {
        config.rng_seed = RngSeed::Fixed(1);
    }
    if std::env::var_os("PROPTEST_CASES").is_none() {
        config.cases = cases;
    }
    if let Err(error) = TestRunner::new(config).run(&strategy, test) {
        panic!("{}\n{error}", gpu().describe());
    }
}

fn ask(placed: &Placed, places: &[DVec3]) -> Vec<f32> {
    let points: Vec<_> = places
        .iter()
        .map(|place| Point::rounded(placed.render(*place), DVec3::Y))
        .collect();
    SunProbe::new(gpu(), &placed.shadow).ask(gpu(), &points)
}

/// Returns the first cascade that covers a receiver on the floor.
fn layer_at(placed: &Placed, place: DVec3) -> Option<usize> {
    let position = placed.render(place).as_vec3().as_dvec3();
    let views = placed.shadow.maps().view_uniforms();
    views
        .iter()
        .position(|view| receiver(view, FILTER, Bias::Auto, position, DVec3::Y).inside)
}

/// Returns the longer side of the texels that a receiver is sampled with, or of the coarsest where
/// no cascade covers it.
fn texel_at(placed: &Placed, place: DVec3) -> f64 {
    let views = placed.report.views.iter();
    let sizes: Vec<f64> = views
        .map(|view| f64::from(view.texel_size_world.max_element()))
        .collect();
    let coarsest = sizes.iter().copied().fold(0.0, f64::max);
    // Where all cascades are empty, texels have no size, and any value serves.
    layer_at(placed, place)
        .map_or(coarsest, |layer| sizes[layer])
        .max(1e-3)
}

/// Bounds the f32 error of a receiver's texel coordinates, both axes together, and of the offset
/// that the bias adds for it.
fn texel_error(placed: &Placed, place: DVec3) -> f64 {
    let position = placed.render(place).as_vec3().as_dvec3();
    layer_at(placed, place).map_or(0.0, |layer| {
        let view = placed.shadow.maps().view_uniforms()[layer];
        let reference = receiver(&view, FILTER, Bias::Auto, position, DVec3::Y);
        let band = band(&view, FILTER, Bias::Auto, position, DVec3::Y, &reference);
        let rounding = band.expect("a floor that is not edge on").texel;
        let size = placed.report.views[layer].texel_size_world.min_element();
        let offset: f32 = member(&view, "mapping.rounding");
        rounding.element_sum() + std::f64::consts::SQRT_2 * f64::from(offset / size)
    })
}

/// What the camera sees of the floor is as dark as the ray-traced truth, wherever the truth is the
/// same for three texels around: one more than the kernel's reach, for the corner of its square and
/// the snapping of vertices.
#[test]
fn every_visible_shadow_is_there_and_no_other() {
    const MARGIN: f64 = 3.0;
    let (dark, lit, undecided) = (Cell::new(0), Cell::new(0), Cell::new(0));
    let count = |cell: &Cell<usize>| cell.set(cell.get() + 1);
    let test = |world: World| {
        let placed = world.place(gpu(), MAP_SIZE, DVec3::ZERO, 1.0, |_| {
            Coverage::Camera(world.camera_view(1.0))
        });
        let places = world.visible_floor(20);
        if places.is_empty() {
            return Ok(());
        }
        for (place, seen) in places.iter().zip(ask(&placed, &places)) {
            let Some(blocked) = world.truth(*place, texel_at(&placed, *place), MARGIN) else {
                count(&undecided);
                continue;
            };
            let boxes = &placed.scene.triangles[..12 * world.boxes.len()];
            let hit = occluded(boxes, *place, -world.light, 1e-6);
            assert_eq!(hit, blocked, "the test's two truths differ at {place}");
            count(if blocked { &dark } else { &lit });
            let wanted = if blocked { 0.0 } else { 1.0 };
            // The tolerance covers sixteen weights, stretched three times.
            let error = (seen - wanted).abs();
            prop_assert!(
                error < 1e-5,
                "{place}: visibility {seen}, truth {wanted}\n{:?}",
                placed.report
            );
        }
        Ok(())
    };
    run(200, world(), test);
    // There are enough receivers of each kind, and the truth is undecided for a minority only.
    let [dark, lit, undecided] = [&dark, &lit, &undecided].map(Cell::get);
    let all = dark + lit + undecided;
    assert!(
        dark > all / 10 && lit > all / 10 && undecided < all / 4,
        "{dark} {lit} {undecided}"
    );
    table::record(
        "random scenes, suns, cameras and splits",
        "what is seen of the floor as the truth says where it is settled",
        format!("0 wrong of {} settled receivers", dark + lit),
    );
}

/// Covers the whole scene, by its bounds or by a camera that sees all of it, so that the f32 matrix
/// of a camera has no influence on the fit.
fn whole_scene(by_camera: bool) -> impl Fn(Aabb) -> Coverage {
    move |bounds| {
        if !by_camera {
            return Coverage::Bounds(bounds);
        }
        let middle = ((bounds.min + bounds.max) * 0.5).as_dvec3();
        let size = f64::from((bounds.max - bounds.min).length());
        let camera = Camera {
            pose: Pose::looking_at(middle + DVec3::new(1.0, 2.0, 3.0) * size, middle),
            lens: Lens::Orthographic {
                sides: [-size, size, -size, size],
                near: 0.0,
                far: 8.0 * size,
            },
            reversed: false,
        };
        Coverage::Camera(camera.view())
    }
}

/// If the same world is seen from another render origin, light-space bounds and depth ranges are
/// the same to the last bit, and visibilities differ by no more than f32 coordinates do.
///
/// A receiver's texel coordinates err by at most `Band::texel` in each of the two frames; the
/// offset along the normal for the rounding of coordinates differs as well. The result of a
/// sharpened kernel changes by no more than its sharpness per texel and axis. Beyond that only
/// comparisons can flip, at receivers as close to a caster as depth resolves, and at texels whose
/// centre lies within 1/256 of an edge, to which vertices snap: at most one in five hundred of the
/// receivers, most of which lie in and around shadows.
#[test]
fn a_moved_origin_changes_nothing() {
    let (same, flipped) = (Cell::new(0), Cell::new(0));
    let test = |(mut world, offset, by_camera): (World, [i32; 3], bool)| {
        // The ends of cascades depend on depths along the view, and these on the camera's f32
        // matrix.
        world.cascades = 1;
        // These are multiples of an eighth up to a thousand: with the coordinates' 64ths they take
        // 16 bits of f32's 24.
        let offset = DVec3::from_array(offset.map(f64::from)) / 8.0;
        let place = |origin| world.place(gpu(), MAP_SIZE, origin, 1.0, whole_scene(by_camera));
        let (here, there) = (place(DVec3::ZERO), place(offset));
        let fitted = |placed: &Placed| {
            let view = placed.report.views[0];
            let size = view.texel_size_world.to_array().map(f32::to_bits);
            (
                view.status,
                view.casters,
                size,
                view.depth_range_world.to_bits(),
            )
        };
        prop_assert_eq!(fitted(&here), fitted(&there));
        let places: Vec<_> = world
            .floor_around_shadows(400)
            .into_iter()
            .map(|place| (place * 1024.0).round() / 1024.0)
            .collect();
        let answers = ask(&here, &places).into_iter().zip(ask(&there, &places));
        for (place, (a, b)) in places.iter().zip(answers) {
            let error = texel_error(&here, *place) + texel_error(&there, *place);
            let tolerance = error * f64::from(FILTER.sharpness()) + 1e-5;
            let within = f64::from((a - b).abs()) <= tolerance;
            let count = if within { &same } else { &flipped };
            count.set(count.get() + 1);
        }
        Ok(())
    };
    let range = || -8000..8000_i32;
    let moved = (world(), [range(), range(), range()], prop::bool::ANY);
    run(60, moved, test);
    let (same, flipped) = (same.get(), flipped.get());
    assert!(flipped * 500 <= same, "{flipped} differ of {same}");
    table::record(
        "random scenes from another origin",
        "the same windows to the bit; at most 1 receiver in 500 beyond rounding",
        format!("{flipped} of {} receivers", same + flipped),
    );
}

/// If the same world is measured in another unit, no bit of any visibility changes. (The units are
/// powers of two, which change no mantissa.)
#[test]
fn another_unit_changes_nothing() {
    let (dark, partial) = (Cell::new(0), Cell::new(0));
    let test = |(world, exponent): (World, i32)| {
        let scale = f64::from(exponent).exp2();
        let place = |scale| {
            world.place(gpu(), MAP_SIZE, DVec3::ZERO, scale, |_| {
                Coverage::Camera(world.camera_view(scale))
            })
        };
        let (metres, others) = (place(1.0), place(scale));
        let places = world.floor_around_shadows(400);
        let answers = ask(&metres, &places).into_iter().zip(ask(&others, &places));
        for (place, (a, b)) in places.iter().zip(answers) {
            prop_assert_eq!(a.to_bits(), b.to_bits(), "{} and {} at {}", a, b, place);
            dark.set(dark.get() + usize::from(a == 0.0));
            partial.set(partial.get() + usize::from(a > 0.0 && a < 1.0));
        }
        Ok(())
    };
    let exponents = prop_oneof![Just(-10), Just(10), Just(-1), Just(20), Just(-20)];
    run(60, (world(), exponents), test);
    let (dark, partial) = (dark.get(), partial.get());
    assert!(
        dark > 1000 && partial > 100,
        "{dark} dark, {partial} partial"
    );
    table::record(
        "random scenes in units of 2^-20 to 2^20",
        "bit-identical",
        format!("0 bits differ in {dark} dark and {partial} partial visibilities"),
    );
}
