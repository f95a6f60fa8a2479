//! Computes the visibility that a filter returns for a receiver and the texels of a map.

use glam::{DVec2, I64Vec2, UVec2};

use crate::receive::Filter;
use crate::receive::reference::{DepthLayer, Receiver};

/// Returns the visibility of the light in [0, 1] that `filter` computes for `receiver`; for a
/// direction-space filter, that of one of its samples. The result is 1 for a receiver that is not
/// inside.
pub fn visibility(filter: Filter, map: &DepthLayer<'_>, receiver: &Receiver) -> f64 {
    if !receiver.inside || receiver.texel.is_nan() {
        return 1.0;
    }
    // Beyond the sides of the map the depths are those of the nearest texel inside, however far.
    let receiver = &Receiver {
        texel: receiver.texel.clamp(DVec2::splat(-1e9), DVec2::splat(1e9)),
        ..*receiver
    };
    match filter {
        Filter::Pcss { .. } => return penumbra(map, receiver, DVec2::X),
        Filter::PcssRotated { .. } => return penumbra(map, receiver, turn(receiver)),
        _ => {}
    }
    let mut receiver = *receiver;
    if !filter.compares_each_texel() {
        receiver.gradient = DVec2::ZERO;
    }
    let nearest = receiver.texel.floor().as_i64vec2();
    match kernel(filter) {
        Kernel::Boxed(radius) => {
            let side = -radius..=radius;
            let taps = side.clone().flat_map(|y| side.clone().map(move |x| (x, y)));
            let sum: f64 = taps
                .map(|(x, y)| lit(map, &receiver, nearest + I64Vec2::new(x, y)))
                .sum();
            sum / ((2 * radius + 1) * (2 * radius + 1)) as f64
        }
        Kernel::Bilinear(row) => {
            let plain = bilinear(map, &receiver, receiver.texel, row);
            sharpened(plain, f64::from(filter.sharpness()))
        }
    }
}

/// Returns the reference depth at a texel: that of the receiver's tangent plane, never farther from
/// the light than the receiver.
fn reference_depth(receiver: &Receiver, texel: I64Vec2) -> f64 {
    let center = texel.as_dvec2() + 0.5;
    receiver.depth + receiver.gradient.dot(center - receiver.texel).max(0.0)
}

/// Returns 1 if the receiver is lit as far as one texel tells, and 0 if it is shadowed.
fn lit(map: &DepthLayer<'_>, receiver: &Receiver, texel: I64Vec2) -> f64 {
    let reference = reference_depth(receiver, texel);
    f64::from(u8::from(reference >= map.depth(texel.x, texel.y)))
}

/// Returns a bilinear comparison at `sample_texel`, convolved with `row` along both axes.
fn bilinear(map: &DepthLayer<'_>, receiver: &Receiver, sample_texel: DVec2, row: &[f64]) -> f64 {
    let from_centers = sample_texel - 0.5;
    let base = from_centers.floor();
    let fraction = from_centers - base;
    let first = base.as_i64vec2() - (row.len() / 2) as i64;
    let across = bilinear_weights(row, fraction.x);
    let down = bilinear_weights(row, fraction.y);
    let mut sum = 0.0;
    for (y, weight_y) in down.iter().enumerate() {
        for (x, weight_x) in across.iter().enumerate() {
            let texel = first + I64Vec2::new(x as i64, y as i64);
            sum += weight_x * weight_y * lit(map, receiver, texel);
        }
    }
    sum
}

/// Returns a visibility whose ramp is stretched around one half.
fn sharpened(visibility: f64, sharpness: f64) -> f64 {
    let ramp = (visibility - 0.5) * sharpness + 0.5;
    // A sharpness of NaN, which every light refuses, changes nothing.
    if ramp.is_nan() { visibility } else { ramp }.clamp(0.0, 1.0)
}

/// Returns the visibility that `wgsl/filter_pcss.wgsl` computes, with sample patterns rotated by
/// `turn` (cosine and sine).
fn penumbra(map: &DepthLayer<'_>, receiver: &Receiver, turn: DVec2) -> f64 {
    const REACH: f64 = 32.0;
    let widest =
        (receiver.penumbra * (1.0 - receiver.depth)).clamp(DVec2::ONE, DVec2::splat(REACH));
    let (mut height_sum, mut count) = (0.0, 0.0);
    for index in 0..24 {
        // Samples lie closer together toward the middle; each is weighted by the area that it
        // stands for.
        let t = (f64::from(index) + 0.5) / 24.0;
        let offset = turn.rotate(DVec2::from_angle(f64::from(index) * GOLDEN_ANGLE)) * t.powf(1.5);
        let first = (receiver.texel + offset * widest - 0.5)
            .floor()
            .as_i64vec2();
        for texel in [(0, 0), (1, 0), (0, 1), (1, 1)].map(|(x, y)| first + I64Vec2::new(x, y)) {
            let depth = map.depth(texel.x, texel.y);
            let height = depth - receiver.depth;
            let aside = ((texel.as_dvec2() + 0.5 - receiver.texel).abs() - 0.5).max(DVec2::ZERO);
            let hides = (aside / receiver.penumbra).length() <= height;
            if depth > reference_depth(receiver, texel) && hides {
                height_sum += t * t * height;
                count += t * t;
            }
        }
    }
    if count == 0.0 {
        return 1.0;
    }
    let radius = (receiver.penumbra * (height_sum / count)).clamp(DVec2::ZERO, DVec2::splat(REACH));
    let hard = sharpened(
        bilinear(map, receiver, receiver.texel, &[1.0, 2.0, 1.0]),
        3.0,
    );
    let soft = disk(32)
        .map(|offset| {
            let sample_texel = receiver.texel + turn.rotate(offset) * radius;
            bilinear(map, receiver, sample_texel, &[1.0])
        })
        .sum::<f64>()
        / 32.0;
    let share = (radius.max_element() - 1.0).clamp(0.0, 1.0);
    hard + (soft - hard) * share
}

/// Returns cosine and sine of the angle by which the half texel of a receiver rotates the sample
/// patterns, as in `wgsl/filter_pcss_rotated.wgsl`.
fn turn(receiver: &Receiver) -> DVec2 {
    let half_texel = (receiver.texel.max(DVec2::ZERO) * 2.0).as_uvec2();
    let first = UVec2::new(receiver.grid & 0xffff, receiver.grid >> 16);
    let cell = half_texel.wrapping_add(first * 2) & UVec2::splat(0x1_ffff);
    let mut bits = cell.x.wrapping_mul(0x9e37_79b1) ^ cell.y.wrapping_mul(0x85eb_ca77);
    bits = (bits ^ (bits >> 16)).wrapping_mul(0x7feb_352d);
    bits = (bits ^ (bits >> 15)).wrapping_mul(0x846c_a68b);
    bits ^= bits >> 16;
    DVec2::from_angle(f64::from(bits >> 8) * std::f64::consts::TAU / 16_777_216.0)
}

/// Is the golden angle in radians, with the digits that the shader uses.
const GOLDEN_ANGLE: f64 = std::f64::consts::TAU * 0.38196601;

/// Returns `count` points spread evenly over the unit disk along a golden-angle spiral (Vogel
/// 1979).
fn disk(count: u32) -> impl Iterator<Item = DVec2> {
    (0..count).map(move |index| {
        let radius = ((f64::from(index) + 0.5) / f64::from(count)).sqrt();
        DVec2::from_angle(f64::from(index) * GOLDEN_ANGLE) * radius
    })
}

/// Describes a filter by its definition.
enum Kernel {
    /// Averages nearest comparisons within this many texels along each axis.
    Boxed(i64),
    /// Convolves a bilinear comparison with a row of integers along each axis.
    Bilinear(&'static [f64]),
}

fn kernel(filter: Filter) -> Kernel {
    match filter {
        // One sample of a direction-space filter is a nearest comparison.
        Filter::Nearest | Filter::DirectionGrid { .. } | Filter::DirectionStar { .. } => {
            Kernel::Boxed(0)
        }
        Filter::Box => Kernel::Boxed(1),
        // A penumbra consists of bilinear comparisons.
        Filter::Hardware
        | Filter::Bilinear { .. }
        | Filter::Pcss { .. }
        | Filter::PcssRotated { .. } => Kernel::Bilinear(&[1.0]),
        Filter::Tent3 { .. } => Kernel::Bilinear(&[1.0, 2.0, 1.0]),
        Filter::Tent5 { .. } => Kernel::Bilinear(&[1.0, 3.0, 4.0, 3.0, 1.0]),
        Filter::Tent7 { .. } => Kernel::Bilinear(&[1.0, 5.0, 12.0, 16.0, 12.0, 5.0, 1.0]),
    }
}

/// Returns the weights of the texels along an axis, from the first that contributes, for a position
/// that is `fraction` of a texel past a centre.
fn bilinear_weights(row: &[f64], fraction: f64) -> Vec<f64> {
    let sum: f64 = row.iter().sum();
    (0..=row.len())
        .map(|i| {
            let here = row.get(i).copied().unwrap_or(0.0);
            let before = if i > 0 { row[i - 1] } else { 0.0 };
            (here * (1.0 - fraction) + before * fraction) / sum
        })
        .collect()
}
