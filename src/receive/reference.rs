//! Contains the CPU reference of the WGSL: the arithmetic of a lookup in f64, which returns what the shader should
//! return for the texels that a map contains.
//!
//! It serves the tests of engines and of the library, which compare the device's results with it. Kernels are computed
//! here by their definition, a bilinear comparison convolved with a row of integers, and not by the shader's closed
//! form.
//!
//! No input makes these functions panic.

use glam::{DMat4, DVec2, DVec3, DVec4, I64Vec2, Mat4, UVec2, Vec2, Vec3, Vec4};

use crate::receive::bias::BiasScheme;
use crate::receive::{Bias, Filter, ShadowViewUniform};

/// Holds one layer of a depth map as read back from the device: rows from the top, in ndc depth (reversed: near 1, far
/// 0).
#[derive(Clone, Copy, Debug)]
pub struct DepthLayer<'a> {
    /// Is the number of texels per side. Any size is accepted, whatever the length of `depths`.
    pub size: u32,
    /// Holds `size * size` depths. Missing depths count as 0, at which nothing casts.
    pub depths: &'a [f32],
}

impl DepthLayer<'_> {
    /// Returns the depth of a texel. Beyond the sides it is that of the nearest texel inside, as the samplers clamp.
    fn depth(&self, x: i64, y: i64) -> f64 {
        let last = (i64::from(self.size) - 1).max(0);
        let [row, column] = [y, x].map(|texel| texel.clamp(0, last).unsigned_abs());
        // The index is below the square of the size, which fits into an unsigned integer of 64 bits.
        let index = row * u64::from(self.size) + column;
        let index = usize::try_from(index).unwrap_or(usize::MAX);
        f64::from(self.depths.get(index).copied().unwrap_or(0.0))
    }
}

/// Holds the position of a receiver in a map, as `ShadowReceiver` in `wgsl/view.wgsl` does.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Receiver {
    /// Is the position in texel coordinates: origin at the top left, centres at halves.
    pub texel: DVec2,
    /// Is the reference depth at `texel` in ndc, with the bias included.
    pub depth: f64,
    /// Is the change of the reference depth per texel along x and y.
    pub gradient: DVec2,
    /// Is the radius of a penumbra in texels per difference of ndc depth.
    pub penumbra: DVec2,
    /// Is the position of the map's first texel in a grid that is fixed in the world, as the member `grid` of the WGSL
    /// struct `ShadowViewUniform` has it.
    pub grid: u32,
    /// Is the result of [`holds`] for the receiver's position. Where it is false, visibility is 1.
    pub inside: bool,
}

/// Returns the receiver at `position` (render space) with the geometric normal `normal` (unit length, on the shaded
/// side), as the shader computes it for a light with this filter and bias.
pub fn receiver(
    view: &ShadowViewUniform,
    filter: Filter,
    bias: Bias,
    position: DVec3,
    normal: DVec3,
) -> Receiver {
    let apart = position - Vec3::from_array(view.anchor).as_dvec3();
    let lateral_error = f64::from(view.lateral_error);
    let depth_error = f64::from(view.depth_error);
    let scheme = bias.scheme(filter);
    let relative = match scheme {
        BiasScheme::Plane | BiasScheme::NormalOffset => clear_of_rounding(view, apart, normal),
        BiasScheme::Manual => apart,
    };
    let across = plane_across_map(view, relative, normal);
    let steepness = across.x.abs() + across.y.abs();
    match scheme {
        BiasScheme::Plane => {
            let offset =
                f64::from(view.offset_texels) * clip_w(view, relative).max(0.0) * steepness
                    + rounding_offset(view);
            let offset = offset.min(0.5 * light_height(view, relative, normal));
            let lifted = relative + normal * offset;
            let plane = plane_across_map(view, lifted, normal);
            if plane.z.abs() > 0.0 {
                let gradient =
                    (-plane.truncate() / plane.z).clamp(DVec2::splat(-1e4), DVec2::splat(1e4));
                let slack = lateral_error * (gradient.x.abs() + gradient.y.abs()) + depth_error;
                receiver_at(view, position, lifted, gradient, slack)
            } else {
                receiver_at(view, position, relative, DVec2::ZERO, depth_error)
            }
        }
        BiasScheme::NormalOffset => {
            let texels = f64::from(view.offset_texels) + lateral_error;
            let growth = texels * steepness * w_row(view).truncate().dot(normal).max(0.0);
            let offset =
                texels * clip_w(view, relative).max(0.0) * steepness / (1.0 - growth.min(0.9));
            let distance = offset + rounding_offset(view);
            if growth >= 0.9 || distance >= light_height(view, relative, normal) {
                return receiver_at(view, position, relative, DVec2::ZERO, 2.0);
            }
            let moved = relative + normal * if distance > 0.0 { distance } else { 0.0 };
            receiver_at(view, position, moved, DVec2::ZERO, depth_error)
        }
        BiasScheme::Manual => {
            let light = Vec4::from_array(view.light).as_dvec4();
            let toward_light = if light.w > 0.0 {
                -relative
            } else {
                light.truncate()
            }
            .normalize();
            let slope = f64::from(view.manual_slope) * (1.0 - normal.dot(toward_light));
            let distance = slope.max(f64::from(view.manual_constant));
            receiver_at(
                view,
                position,
                relative + toward_light * distance,
                DVec2::ZERO,
                0.0,
            )
        }
    }
}

/// Returns the visibility of the light in [0, 1] that `filter` computes for `receiver`; for a direction-space filter,
/// that of one of its samples. The result is 1 for a receiver that is not inside, or whose texel lies off the map.
pub fn visibility(filter: Filter, map: &DepthLayer<'_>, receiver: &Receiver) -> f64 {
    let size = f64::from(map.size);
    if !receiver.inside || !is_on_map(receiver.texel, size) {
        return 1.0;
    }
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

/// Returns the reference depth at a texel: that of the receiver's tangent plane, never farther from the light than the
/// receiver.
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

/// Returns the visibility that `wgsl/filter_pcss.wgsl` computes, with sample patterns rotated by `turn` (cosine and
/// sine).
fn penumbra(map: &DepthLayer<'_>, receiver: &Receiver, turn: DVec2) -> f64 {
    const REACH: f64 = 32.0;
    let widest =
        (receiver.penumbra * (1.0 - receiver.depth)).clamp(DVec2::ONE, DVec2::splat(REACH));
    let (mut height_sum, mut count) = (0.0, 0.0);
    for index in 0..24 {
        // Samples lie closer together toward the middle; each is weighted by the area that it stands for.
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

/// Returns cosine and sine of the angle by which the half texel of a receiver rotates the sample patterns, as in
/// `wgsl/filter_pcss_rotated.wgsl`.
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

/// Returns `count` points spread evenly over the unit disk along a golden-angle spiral (Vogel 1979).
fn disk(count: u32) -> impl Iterator<Item = DVec2> {
    (0..count).map(move |index| {
        let radius = ((f64::from(index) + 0.5) / f64::from(count)).sqrt();
        DVec2::from_angle(f64::from(index) * GOLDEN_ANGLE) * radius
    })
}

/// Is `SHADOW_POSITION_ROUNDING` of `wgsl/view.wgsl`.
const POSITION_ROUNDING: f64 = 2.0 * f32::EPSILON as f64;

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

/// Returns the weights of the texels along an axis, from the first that contributes, for a position that is `fraction`
/// of a texel past a centre.
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

fn matrix(view: &ShadowViewUniform) -> DMat4 {
    Mat4::from_cols_array_2d(&view.texel_from_anchor).as_dmat4()
}

fn w_row(view: &ShadowViewUniform) -> DVec4 {
    matrix(view).row(3)
}

fn clip_w(view: &ShadowViewUniform, relative: DVec3) -> f64 {
    w_row(view).dot(relative.extend(1.0))
}

/// Returns what `shadow_clear_of_rounding` of `wgsl/view.wgsl` returns.
fn clear_of_rounding(view: &ShadowViewUniform, relative: DVec3, normal: DVec3) -> DVec3 {
    if view.light[3] <= 0.0 {
        return relative;
    }
    let rounding = f64::from(view.offset_world) + POSITION_ROUNDING * relative.abs().max_element();
    let share = rounding / light_height(view, relative, normal).max(2.0 * rounding);
    relative * (1.0 - share)
}

/// Returns what `shadow_rounding_offset` of `wgsl/view.wgsl` returns.
fn rounding_offset(view: &ShadowViewUniform) -> f64 {
    if view.light[3] > 0.0 {
        0.0
    } else {
        f64::from(view.offset_world)
    }
}

/// Returns the world distance of the light from the tangent plane at a position; infinite for a directional light.
fn light_height(view: &ShadowViewUniform, relative: DVec3, normal: DVec3) -> f64 {
    if view.light[3] > 0.0 {
        normal.dot(relative).abs()
    } else {
        f64::INFINITY
    }
}

/// Returns the receiver's tangent plane in texel space: its components along texel x, texel y and depth.
fn plane_across_map(view: &ShadowViewUniform, relative: DVec3, normal: DVec3) -> DVec3 {
    let plane = normal.extend(-normal.dot(relative));
    let row = |row: [f32; 4]| Vec4::from_array(row).as_dvec4().dot(plane);
    DVec3::new(
        row(view.plane_across),
        row(view.plane_down),
        row(view.plane_depth),
    )
}

/// Returns whether the map of `view` covers `position` (render space), as `shadow_view_holds` in `wgsl/view.wgsl` does:
/// within its sides, not beyond its far plane, and for a local light in front of it and within its cone and range. A
/// position that no view covers is lit.
pub fn holds(view: &ShadowViewUniform, position: DVec3) -> bool {
    let relative = position - Vec3::from_array(view.anchor).as_dvec3();
    let homogeneous = matrix(view) * relative.extend(1.0);
    let texel = homogeneous.truncate().truncate() / homogeneous.w;
    let inner = Vec4::from_array(view.inner).as_dvec4();
    let within = texel.cmpge(DVec2::new(inner.x, inner.y)).all()
        && texel.cmple(DVec2::new(inner.z, inner.w)).all();
    let light = Vec4::from_array(view.light).as_dvec4();
    let reached = relative.length() <= f64::from(view.range)
        && -relative.dot(light.truncate()) >= f64::from(view.cone_cosine) * relative.length();
    within && reached && homogeneous.w > 0.0 && homogeneous.z >= 0.0
}

/// Is the least weight of a cascade. It is above 0, so that every position within a cascade has a weighted mean.
const LEAST_WEIGHT: f64 = 1.0 / 4096.0;

/// Returns the weight, from 1/4096 to 1, of a cascade at a `position` (render space) that it covers, where cascades
/// blend. It is the `shadow_view_weight` of `wgsl/view.wgsl`.
pub fn weight(view: &ShadowViewUniform, position: DVec3) -> f64 {
    let relative = position - Vec3::from_array(view.anchor).as_dvec3();
    let homogeneous = matrix(view) * relative.extend(1.0);
    let texel = homogeneous.truncate().truncate() / homogeneous.w;
    let inner = Vec4::from_array(view.inner).as_dvec4();
    let from_border =
        (texel - inner.truncate().truncate()).min(DVec2::new(inner.z, inner.w) - texel);
    let share = from_border.min_element() / f64::from(view.fade_texels);
    // A share of NaN gives the least weight.
    if share >= LEAST_WEIGHT {
        share.min(1.0)
    } else {
        LEAST_WEIGHT
    }
}

fn is_on_map(texel: DVec2, size: f64) -> bool {
    texel.cmpge(DVec2::ZERO).all() && texel.cmple(DVec2::splat(size)).all()
}

fn receiver_at(
    view: &ShadowViewUniform,
    position: DVec3,
    moved: DVec3,
    gradient: DVec2,
    offset: f64,
) -> Receiver {
    let homogeneous = matrix(view) * moved.extend(1.0);
    let texel = homogeneous.truncate().truncate() / homogeneous.w;
    let on_map = is_on_map(texel, f64::from(view.map_size));
    let depth = homogeneous.z / homogeneous.w;
    Receiver {
        texel,
        depth: if homogeneous.w > 0.0 && on_map {
            depth + offset + depth * f64::from(view.depth_error_relative)
        } else {
            2.0
        },
        gradient,
        penumbra: Vec2::from_array(view.penumbra).as_dvec2(),
        grid: view.grid,
        inside: holds(view, position),
    }
}
