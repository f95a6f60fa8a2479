//! The fit of a local light's views: the part of each that receivers and casters share, and a near plane for all of them.
//!
//! Map coordinates of a perspective view are tangents, x / w and y / w with w the distance along the view's axis, and ndc depth
//! is near / w (reversed, infinite far plane): its relative error is that of f32 at any distance.

use glam::{DVec2, DVec3};

use crate::Aabb;
use crate::fit::axes::LightAxes;
use crate::fit::camera::CameraFrustum;
use crate::fit::region::{HalfSpace, HalfSpaces};
use crate::fit::window::{MapWindow, WindowRequest};

/// Most views of one local light.
pub(crate) const MAX_LOCAL_VIEWS: usize = 6;

/// The nearest near plane, as a share of the light's reach. The rasteriser interpolates near / w in f32: across a triangle
/// that starts at the near plane its error at distance w is w² / near · 2⁻²⁴, at the full reach 1024 · 2⁻²⁴ = 6·10⁻⁵ of it.
/// Casters nearer to the light than this cast nothing.
const NEAREST_SHARE: f64 = 1.0 / 1024.0;

/// What a frame brings.
pub(crate) struct LocalInput<'a> {
    pub origin: DVec3,
    pub position_world: DVec3,
    /// World units; may be infinite.
    pub range: f64,
    /// Axes of each view: it looks against its z axis.
    pub views: &'a [LightAxes],
    /// Tangent of half the angle over which a view has receivers.
    pub receiver_tangent: f64,
    /// The same for casters: wider by what a kernel at the border reaches.
    pub caster_tangent: f64,
    /// Lookups reach beyond the place of their receiver: views are not limited to where receivers are seen.
    pub looks_around: bool,
    /// Limits receivers to what a camera sees.
    pub camera: Option<&'a CameraFrustum>,
    /// Bounds of casters, which receive too.
    pub casters: &'a [Aabb],
    /// Bounds of surfaces that only receive.
    pub receivers: &'a [Aabb],
    pub map_size: u32,
    pub margin_texels: u32,
}

/// The windows of a local light, kept from frame to frame for their hysteresis.
#[derive(Clone, Debug, Default)]
pub(crate) struct LocalFit {
    /// In tangents; none for a view that nothing can shadow.
    pub windows: [Option<MapWindow>; MAX_LOCAL_VIEWS],
    held: [Option<MapWindow>; MAX_LOCAL_VIEWS],
    /// World distance of the near plane along every view's axis.
    pub near: f64,
    /// World distance beyond which nothing receives.
    pub reach: f64,
}

/// A rectangle of tangents and the nearest distance along the axis.
struct Extent {
    min: DVec2,
    max: DVec2,
    nearest: f64,
}

impl LocalFit {
    /// The windows for this frame; `drawn` is filled with the indices of the casters of each view.
    pub fn fit(&self, input: &LocalInput<'_>, drawn: &mut [Vec<u32>]) -> Self {
        let light = input.position_world - input.origin;
        let reach = reach(input, light);
        let mut next = Self {
            windows: [None; MAX_LOCAL_VIEWS],
            reach,
            near: f64::INFINITY,
            held: self.held,
        };
        drawn.iter_mut().for_each(Vec::clear);
        if reach <= 0.0 {
            next.near = 1.0;
            return next;
        }
        let nearest = reach * NEAREST_SHARE;
        let within = within_reach(light, reach);
        let visible = visible_bounds(input, &within);
        let casts = |caster: &Aabb| can_shadow(caster, &visible, light);
        for (index, axes) in input.views.iter().enumerate() {
            let view = ViewFrame { axes, light };
            let square =
                |tangent: f64| view.region(DVec2::splat(-tangent), DVec2::splat(tangent), nearest);
            let field = square(input.caster_tangent);
            let mut seen = square(input.receiver_tangent);
            if let Some(camera) = input.camera {
                camera
                    .planes
                    .as_slice()
                    .iter()
                    .for_each(|plane| seen.push(*plane));
            }
            let casters = input.casters.iter().filter(|caster| casts(caster));
            let Some(cast) = view.extent(&field, casters.map(|c| intersection(c, &within))) else {
                continue;
            };
            let (mut min, mut max) = (cast.min, cast.max);
            if !input.looks_around {
                let receivers = input.casters.iter().chain(input.receivers);
                let received = view.extent(&seen, receivers.map(|r| intersection(r, &within)));
                let Some(received) = received else { continue };
                min = min.max(received.min);
                max = max.min(received.max);
            }
            if min.cmpgt(max).any() {
                continue;
            }
            let window = MapWindow::fit(
                &WindowRequest {
                    min,
                    max,
                    map_size: input.map_size,
                    margin_texels: input.margin_texels,
                    texel_floor: texel_floor(light, nearest),
                    whole: input.caster_tangent,
                },
                self.held[index].as_ref(),
            );
            let region = view.region(window.min, window.max(), nearest);
            for (caster, bounds) in (0u32..).zip(input.casters) {
                let clipped = intersection(bounds, &within);
                if !casts(bounds) {
                    continue;
                }
                if let Some(extent) = view.extent(&region, [clipped]) {
                    drawn[index].push(caster);
                    next.near = next.near.min(extent.nearest);
                }
            }
            if !drawn[index].is_empty() {
                next.windows[index] = Some(window);
                next.held[index] = Some(window);
            }
        }
        // A power of two, so that it changes rarely; no farther than the reach, where nothing casts.
        next.near = next
            .near
            .clamp(nearest, reach)
            .log2()
            .floor()
            .exp2()
            .max(nearest);
        next
    }
}

/// One view's axes at the light's place in render space.
struct ViewFrame<'a> {
    axes: &'a LightAxes,
    light: DVec3,
}

impl ViewFrame<'_> {
    /// The pyramid over a rectangle of tangents, from `nearest` along the axis on.
    fn region(&self, min: DVec2, max: DVec2, nearest: f64) -> HalfSpaces {
        let (right, up, forward) = (self.axes.right(), self.axes.up(), -self.axes.toward_light());
        let mut region = HalfSpaces::default();
        for side in [
            right - forward * min.x,
            forward * max.x - right,
            up - forward * min.y,
            forward * max.y - up,
        ] {
            let normal = side.normalize();
            region.push(HalfSpace {
                normal,
                offset: -normal.dot(self.light),
            });
        }
        region.push(HalfSpace {
            normal: forward,
            offset: -forward.dot(self.light) - nearest,
        });
        region
    }

    /// What of the boxes lies in the region, in tangents; none for nothing.
    fn extent(&self, region: &HalfSpaces, boxes: impl IntoIterator<Item = Aabb>) -> Option<Extent> {
        let mut extent = Extent {
            min: DVec2::INFINITY,
            max: DVec2::NEG_INFINITY,
            nearest: f64::INFINITY,
        };
        for bounds in boxes {
            region.visit_vertices(&bounds, |vertex| {
                let local = self.axes.light_from_world * (vertex - self.light);
                let distance = -local.z;
                let tangents = local.truncate() / distance;
                extent.min = extent.min.min(tangents);
                extent.max = extent.max.max(tangents);
                extent.nearest = extent.nearest.min(distance);
            });
        }
        extent.min.cmple(extent.max).all().then_some(extent)
    }
}

/// How far the light matters: its range, or the farthest corner of anything where the range goes beyond.
fn reach(input: &LocalInput<'_>, light: DVec3) -> f64 {
    input
        .casters
        .iter()
        .chain(input.receivers)
        .filter(|bounds| !bounds.is_empty())
        .map(|bounds| {
            let (min, max) = (bounds.min.as_dvec3(), bounds.max.as_dvec3());
            (light - min).abs().max((light - max).abs()).length()
        })
        .fold(0.0, f64::max)
        .min(input.range)
}

/// The box around the sphere that the light reaches, rounded outward to f32.
fn within_reach(light: DVec3, reach: f64) -> Aabb {
    let outward = reach * (1.0 + 1e-6) + light.abs().max_element() * 1e-6;
    Aabb::new((light - outward).as_vec3(), (light + outward).as_vec3())
}

fn intersection(a: &Aabb, b: &Aabb) -> Aabb {
    Aabb::new(a.min.max(b.min), a.max.min(b.max))
}

/// Bounds of the receivers that the light reaches and the camera, if any, sees.
fn visible_bounds(input: &LocalInput<'_>, within: &Aabb) -> (DVec3, DVec3) {
    let all = HalfSpaces::default();
    let seen = input.camera.map_or(&all, |camera| &camera.planes);
    let (mut min, mut max) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
    for bounds in input.casters.iter().chain(input.receivers) {
        seen.visit_vertices(&intersection(bounds, within), |vertex| {
            min = min.min(vertex);
            max = max.max(vertex);
        });
    }
    (min, max)
}

/// Can a shadow of `caster` fall on anything in `visible`? Shadows lead away from the light: on an axis on which the light lies
/// to one side of the caster, some receiver must lie beyond the caster's near side. The flat wall of a room fails this.
fn can_shadow(caster: &Aabb, visible: &(DVec3, DVec3), light: DVec3) -> bool {
    let (low, high) = (caster.min.as_dvec3(), caster.max.as_dvec3());
    !caster.is_empty()
        && (0..3).all(|axis| {
            if light[axis] < low[axis] {
                visible.1[axis] > low[axis]
            } else if light[axis] > high[axis] {
                visible.0[axis] < high[axis]
            } else {
                true
            }
        })
}

/// Finest texel, as a tangent: four ulps of f32 at the light's render coordinates seen from the end of its reach, and at least
/// four ulps of one, the tangent at a view's border. Close to the light texels may be finer than positions; at its reach not.
fn texel_floor(light: DVec3, nearest: f64) -> f64 {
    let reach = nearest / NEAREST_SHARE;
    4.0 * f64::from(f32::EPSILON) * (light.abs().max_element() / reach).max(1.0)
}
