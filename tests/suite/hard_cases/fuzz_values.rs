//! Generates values for every field, ordinary and invalid, and runs tests over them while watching
//! the device for errors.

use std::cell::Cell;

use glam::{DVec3, Mat4, Vec3, Vec4};
use proptest::prelude::*;
use proptest::test_runner::{Config, RngSeed, TestRunner};
use shadow_support::camera::Camera;
use wgpu_shadows::{Aabb, Bias, CameraView, Filter};

use super::table;
use crate::fixtures::gpu::gpu;

/// Runs `test` on that many cases, each within error scopes that must stay empty.
pub fn run<S: Strategy>(
    cases: u32,
    strategy: S,
    test: impl Fn(S::Value) -> Result<(), TestCaseError>,
) {
    let mut config = Config {
        failure_persistence: None,
        ..Config::default()
    };
    if config.rng_seed == RngSeed::Random {
        config.rng_seed = RngSeed::Fixed(2);
    }
    if std::env::var_os("PROPTEST_CASES").is_none() {
        config.cases = cases;
    }
    let scoped = |value| {
        let device = &gpu().device;
        let internal = device.push_error_scope(wgpu::ErrorFilter::Internal);
        let validation = device.push_error_scope(wgpu::ErrorFilter::Validation);
        let result = test(value);
        let errors = [
            pollster::block_on(validation.pop()),
            pollster::block_on(internal.pop()),
        ];
        prop_assert!(errors.iter().all(Option::is_none), "{errors:?}");
        result
    };
    if let Err(error) = TestRunner::new(config).run(&strategy, scoped) {
        panic!("{}\n{error}", gpu().describe());
    }
}

/// Generates mostly ordinary numbers, some at the limits of f32, and a few of any bits.
pub fn number() -> impl Strategy<Value = f32> + Clone {
    let odd = prop::sample::select(vec![
        0.0,
        -0.0,
        f32::NAN,
        f32::INFINITY,
        f32::NEG_INFINITY,
        f32::MAX,
        f32::MIN,
        f32::MIN_POSITIVE,
        1e-45,
        1e30,
        -1e18,
    ]);
    prop_oneof![30 => -8.0..8.0_f32, 1 => odd, 1 => any::<u32>().prop_map(f32::from_bits)]
}

pub fn vector() -> impl Strategy<Value = Vec3> {
    (number(), number(), number()).prop_map(|(x, y, z)| Vec3::new(x, y, z))
}

pub fn matrix() -> impl Strategy<Value = Mat4> {
    prop::array::uniform4((vector(), number())).prop_map(|columns| {
        let [x, y, z, w] = columns.map(Vec4::from);
        Mat4::from_cols(x, y, z, w)
    })
}

pub fn bounds() -> impl Strategy<Value = Aabb> {
    (vector(), vector(), any::<bool>()).prop_map(|(a, b, ordered)| {
        let high = if ordered { a + b.abs() } else { b };
        Aabb::new(a, high)
    })
}

fn camera() -> impl Strategy<Value = CameraView> {
    let fine = Camera::modern(DVec3::new(3.0, 4.0, 5.0), DVec3::ZERO, 1.0, 1.0).view();
    (matrix(), matrix(), number(), 0..4, vector()).prop_map(
        move |(view, clip, max_distance, kind, eye)| CameraView {
            view_from_render: match kind {
                0 => view,
                1 => Mat4::from_translation(eye),
                _ => fine.view_from_render,
            },
            clip_from_view: if kind == 1 { clip } else { fine.clip_from_view },
            max_distance: if kind == 3 {
                f32::INFINITY
            } else {
                max_distance
            },
        },
    )
}

pub fn filter() -> impl Strategy<Value = Filter> {
    (0..11, number()).prop_map(|(kind, x)| match kind {
        0 => Filter::Nearest,
        1 => Filter::Hardware,
        2 => Filter::Box,
        3 => Filter::Bilinear { sharpness: x },
        4 => Filter::Tent3 { sharpness: x },
        5 => Filter::Tent5 { sharpness: x },
        6 => Filter::Tent7 { sharpness: x },
        7 => Filter::Pcss { light_size: x },
        8 => Filter::PcssRotated { light_size: x },
        9 => Filter::DirectionGrid { radius: x },
        _ => Filter::DirectionStar { radius: x },
    })
}

pub fn bias() -> impl Strategy<Value = Bias> {
    (0..3, number(), number()).prop_map(|(kind, constant, slope)| match kind {
        0 => Bias::Auto,
        1 => Bias::NormalOffset,
        _ => Bias::Manual { constant, slope },
    })
}

/// Generates sizes that a test can afford, or that must be refused.
pub fn size() -> impl Strategy<Value = u32> {
    prop_oneof![6 => 0..40_u32, 1 => Just(u32::MAX), 1 => 8193..u32::MAX]
}

/// Holds everything that a frame of any light has.
#[derive(Clone, Debug)]
pub struct Numbers {
    pub origin: Vec3,
    pub place: Vec3,
    pub direction: Vec3,
    pub up: Vec3,
    pub range: f32,
    pub angle: f32,
    pub bounds: Aabb,
    pub receiver: Aabb,
    pub cover: Aabb,
    pub camera: Option<CameraView>,
    pub importance: f32,
    pub max_views: Option<u32>,
    pub points: Vec<(Vec3, Vec3)>,
}

pub fn numbers() -> impl Strategy<Value = Numbers> {
    let light = (vector(), vector(), vector(), vector(), number(), number());
    let boxes = (bounds(), bounds(), bounds());
    let pool = (number(), prop::option::of(0..4_u32));
    let points = prop::collection::vec((vector(), vector()), 4);
    (light, boxes, prop::option::of(camera()), pool, points).prop_map(
        |(light, boxes, camera, (importance, max_views), points)| {
            let (origin, place, direction, up, range, angle) = light;
            let (bounds, receiver, cover) = boxes;
            Numbers {
                origin,
                place,
                direction,
                up,
                range: range.abs(),
                angle: angle.abs() * 0.2,
                bounds,
                receiver,
                cover,
                camera,
                importance: importance.abs(),
                max_views,
                points,
            }
        },
    )
}

/// Counts the cases that were accepted and those that were refused.
#[derive(Default)]
pub struct Counts {
    taken: Cell<usize>,
    refused: Cell<usize>,
}

impl Counts {
    pub fn count<T, E>(&self, result: &Result<T, E>) {
        let cell = match result {
            Ok(_) => &self.taken,
            Err(_) => &self.refused,
        };
        cell.set(cell.get() + 1);
    }

    pub fn finish(&self, case: &str, expectation: &str) {
        let (taken, refused) = (self.taken.get(), self.refused.get());
        assert!(
            taken > 30 && refused > 30,
            "{taken} taken, {refused} refused"
        );
        let words = format!("{taken} taken, {refused} refused, 0 broken");
        table::record(case, expectation, words);
    }
}
