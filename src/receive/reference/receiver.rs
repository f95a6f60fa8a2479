//! Computes where a receiver lies in a map, as `wgsl/view.wgsl` and `wgsl/bias_*.wgsl` do.

use glam::{DMat4, DVec2, DVec3, DVec4, Mat4, Vec2, Vec3, Vec4};

use crate::receive::bias::BiasScheme;
use crate::receive::{Bias, Filter, ShadowViewUniform};

/// Is `SHADOW_POSITION_ROUNDING` of `wgsl/view.wgsl`.
const POSITION_ROUNDING: f64 = 2.0 * f32::EPSILON as f64;

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
    /// Is the position of the map's first texel in a grid that is fixed in the world, as the member
    /// `grid` of the WGSL struct `ShadowViewUniform` has it.
    pub grid: u32,
    /// Is the result of [`holds`] for the receiver's position. Where it is false, visibility is 1.
    pub inside: bool,
}

/// Returns the receiver at `position` (render space) with the geometric normal `normal` (unit
/// length, on the shaded side), as the shader computes it for a light with this filter and bias.
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

/// Returns the world distance of the light from the tangent plane at a position; infinite for a
/// directional light.
fn light_height(view: &ShadowViewUniform, relative: DVec3, normal: DVec3) -> f64 {
    if view.light[3] > 0.0 {
        normal.dot(relative).abs()
    } else {
        f64::INFINITY
    }
}

/// Returns the receiver's tangent plane in texel space: its components along texel x, texel y and
/// depth.
fn plane_across_map(view: &ShadowViewUniform, relative: DVec3, normal: DVec3) -> DVec3 {
    let plane = normal.extend(-normal.dot(relative));
    let row = |row: [f32; 4]| Vec4::from_array(row).as_dvec4().dot(plane);
    DVec3::new(
        row(view.plane_across),
        row(view.plane_down),
        row(view.plane_depth),
    )
}

/// Returns whether the map of `view` covers `position` (render space), as `shadow_view_holds` in
/// `wgsl/view.wgsl` does: within its sides, not beyond its far plane, and for a local light in
/// front of it and within its cone and range. A position that no view covers is lit.
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

/// Is the least weight of a cascade. It is above 0, so that every position within a cascade has a
/// weighted mean.
const LEAST_WEIGHT: f64 = 1.0 / 4096.0;

/// Returns the weight, from 1/4096 to 1, of a cascade at a `position` (render space) that it
/// covers, where cascades blend. It is the `shadow_view_weight` of `wgsl/view.wgsl`.
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

/// Returns whether a position in texel coordinates is on a map with `size` texels per side.
pub(super) fn is_on_map(texel: DVec2, size: f64) -> bool {
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
