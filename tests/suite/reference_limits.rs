//! Tests the CPU reference of the WGSL at the limits of its types: every result is in 0..=1, and
//! nothing panics. Tests are built with overflow checks, so that an index that wraps is noticed.

use glam::{DVec2, DVec3};
use shadow_support::random::Random;
use wgpu_shadows::reference::{DepthLayer, Receiver, holds, receiver, visibility, weight};
use wgpu_shadows::{Bias, Filter, ShadowViewUniform};

use crate::fixtures::view_member::with_member;

const FILTERS: [Filter; 11] = [
    Filter::Nearest,
    Filter::Hardware,
    Filter::Box,
    Filter::Bilinear { sharpness: 1.0 },
    Filter::Tent3 { sharpness: 2.0 },
    Filter::Tent5 { sharpness: 3.0 },
    Filter::Tent7 { sharpness: 4.0 },
    Filter::Pcss { light_size: 0.1 },
    Filter::PcssRotated { light_size: 0.1 },
    Filter::DirectionGrid { radius: 0.1 },
    Filter::DirectionStar { radius: 0.1 },
];

const BIASES: [Bias; 3] = [
    Bias::Auto,
    Bias::NormalOffset,
    Bias::Manual {
        constant: 0.01,
        slope: 0.02,
    },
];

/// Are sizes whose squares exceed i64 (from 3 037 000 500 on) or come close, and the smallest ones.
const SIZES: [u32; 7] = [
    0,
    1,
    2,
    3_037_000_499,
    3_037_000_500,
    u32::MAX - 1,
    u32::MAX,
];

/// Returns a number of any bits, half of them from the limits of f64.
fn any_number(random: &mut Random) -> f64 {
    const ODD: [f64; 14] = [
        0.0,
        -0.0,
        1.0,
        0.5,
        f64::NAN,
        f64::INFINITY,
        f64::NEG_INFINITY,
        f64::MAX,
        f64::MIN,
        f64::MIN_POSITIVE,
        5e-324,
        4_294_967_295.0,
        9.3e18,
        -9.3e18,
    ];
    if random.index(2) == 0 {
        ODD[random.index(ODD.len())]
    } else {
        f64::from_bits(random.bits())
    }
}

fn any_pair(random: &mut Random) -> DVec2 {
    DVec2::new(any_number(random), any_number(random))
}

fn any_vector(random: &mut Random) -> DVec3 {
    any_pair(random).extend(any_number(random))
}

fn assert_answers(map: &DepthLayer<'_>, receiver: &Receiver) {
    for filter in FILTERS {
        let seen = visibility(filter, map, receiver);
        assert!(
            (0.0..=1.0).contains(&seen),
            "{seen} of {filter:?}, size {}, {receiver:?}",
            map.size
        );
    }
}

/// In a map of which one texel is known, the nearest position is shadowed by it, and the farthest,
/// whose texels are missing and count as empty, is lit.
#[test]
fn a_layer_of_any_size_has_corners() {
    let at = |place: f64| Receiver {
        texel: DVec2::splat(place),
        depth: 0.5,
        gradient: DVec2::ZERO,
        penumbra: DVec2::splat(1e-3),
        grid: 0,
        inside: true,
    };
    for size in SIZES.into_iter().filter(|size| *size > 2) {
        let map = DepthLayer {
            size,
            depths: &[0.9],
        };
        assert_eq!(visibility(Filter::Nearest, &map, &at(0.5)), 0.0);
        for place in [f64::from(size) - 0.5, f64::from(size)] {
            for filter in FILTERS {
                let seen = visibility(filter, &map, &at(place));
                assert_eq!(seen, 1.0, "{filter:?}, size {size}, texel {place}");
            }
        }
    }
}

/// Receivers of any numbers are sampled over maps of any size, and so are receivers on the map,
/// which reach its texels.
#[test]
fn any_receiver_has_a_visibility() {
    let mut random = Random::new(31);
    let depths: Vec<f32> = (0..16)
        .map(|_| any_number(&mut random) as f32)
        .chain([0.25, f32::INFINITY, f32::NAN, f32::MAX])
        .collect();
    let mut shadowed = 0;
    for case in 0..6000 {
        let size = if case % 3 == 0 {
            random.bits() as u32
        } else {
            SIZES[random.index(SIZES.len())]
        };
        let map = DepthLayer {
            size,
            depths: &depths,
        };
        let share = DVec2::new(random.range(0.0, 1.0), random.range(0.0, 1.0));
        let texel = match case % 4 {
            0 => any_pair(&mut random),
            1 => share * f64::from(size),
            2 => DVec2::splat(f64::from(size)),
            _ => share * 4.0,
        };
        let receiver = Receiver {
            texel,
            depth: any_number(&mut random),
            gradient: any_pair(&mut random),
            penumbra: any_pair(&mut random),
            grid: random.bits() as u32,
            inside: true,
        };
        assert_answers(&map, &receiver);
        shadowed += usize::from(visibility(Filter::Nearest, &map, &receiver) < 1.0);
    }
    assert!(shadowed > 100, "{shadowed}");
}

/// Uniforms have any bits, positions and normals any numbers; the receivers that result are
/// sampled.
#[test]
fn any_uniform_has_a_receiver() {
    let mut random = Random::new(32);
    for case in 0..6000 {
        let mut words = [0_u32; size_of::<ShadowViewUniform>() / 4];
        for word in &mut words {
            *word = match random.index(3) {
                0 => (any_number(&mut random) as f32).to_bits(),
                1 => (random.range(-4.0, 4.0) as f32).to_bits(),
                _ => random.bits() as u32,
            };
        }
        let view = bytemuck::pod_read_unaligned(bytemuck::cast_slice(&words));
        let view = with_member(view, "map_size", SIZES[case % SIZES.len()] as f32);
        let (position, normal) = (any_vector(&mut random), any_vector(&mut random));
        let share = weight(&view, position);
        assert!((0.0..=1.0).contains(&share), "{share} of {view:?}");
        let map = DepthLayer {
            size: SIZES[random.index(SIZES.len())],
            depths: &[0.5, 0.25],
        };
        for bias in BIASES {
            for filter in FILTERS {
                let found = receiver(&view, filter, bias, position, normal);
                assert_eq!(found.inside, holds(&view, position));
                let inside = Receiver {
                    inside: true,
                    ..found
                };
                assert_answers(&map, &inside);
            }
        }
    }
}
