//! Fits the cascades of a directional light to the visible receivers and to every caster that can reach them.

use glam::DVec3;

use crate::fit::axes::{LightAxes, LightBox};
use crate::fit::camera::CameraFrustum;
use crate::fit::extruded_rect::{ExtrudedRect, push_extruded_rect};
use crate::fit::footprint::{FootprintScratch, Slice, SliceReport};
use crate::fit::map_rect::{DepthRange, LightSpaceBounds, MapRect, MapRectRequest};
use crate::fit::region::HalfSpaces;
use crate::fit::spacing::Spacing;
use crate::fit::split::{MAX_CASCADES, SplitRule};
use crate::fit::stability::Stability;
use crate::fit::visible::{self, Seen, SeenBounds};
use crate::{Aabb, ShadowError};

/// Selects the receivers that count.
#[derive(Clone, Copy)]
pub(crate) enum Region<'a> {
    /// Counts what any of these cameras sees of the receivers.
    Cameras(&'a [CameraFrustum]),
    /// Counts all that is inside a given box. The light-space bounds then cover the box, whatever the casters.
    Bounds(Aabb),
    /// Counts all receivers.
    Everything,
}

/// Holds the input of a frame.
pub(crate) struct FitInput<'a> {
    pub axes: LightAxes,
    pub origin: DVec3,
    pub region: Region<'a>,
    /// Holds the bounds of what casts; empty ones cast nothing.
    pub casters: &'a [Aabb],
    /// Holds the bounds of what receives.
    pub receivers: &'a [Aabb],
}

/// Holds the settings that the light was made with.
#[derive(Clone, Copy, Debug)]
pub(crate) struct FitLimits {
    pub map_size: u32,
    pub margin_texels: u32,
    pub cascades: usize,
    pub split: SplitRule,
    pub stability: Stability,
}

/// Holds what the fit needs to know of a caster.
#[derive(Clone, Copy, Debug)]
struct CasterBounds {
    light: LightBox,
    /// Is false where no visible receiver is behind the caster: a ground plane below everything shadows nothing.
    can_shadow: bool,
}

impl CasterBounds {
    /// Returns the light-space box of the caster, grown by all that rounding may have taken from it: a test that
    /// rejects the caster must reject this box.
    fn widest_light(&self, spacing: Spacing) -> LightBox {
        spacing.widest(&self.light)
    }
}

/// Holds the light-space bounds of a light's cascades, kept from frame to frame for their hysteresis.
#[derive(Clone, Debug, Default)]
pub(crate) struct DirectionalFit {
    /// Has one entry per cascade, `None` for a cascade in which nothing can cast a shadow.
    pub light_bounds: [Option<LightSpaceBounds>; MAX_CASCADES],
    held: [Option<LightSpaceBounds>; MAX_CASCADES],
    /// Describes the slices of the cascades of a camera's view.
    pub slices: [Option<SliceReport>; MAX_CASCADES],
}

/// Holds lists that are reused from frame to frame.
#[derive(Debug, Default)]
pub(crate) struct FitScratch {
    /// Has one entry per caster, in order.
    casters: Vec<CasterBounds>,
    seen: Vec<Seen>,
    footprint: FootprintScratch,
}

impl DirectionalFit {
    /// Returns the fit for this frame and fills `scratch.casters`.
    ///
    /// Returns an error where casters and receivers are so far from the world's origin that f64 does not distinguish
    /// their positions.
    pub fn fit(
        &self,
        input: &FitInput<'_>,
        limits: &FitLimits,
        scratch: &mut FitScratch,
    ) -> Result<Self, ShadowError> {
        let visible = match &input.region {
            Region::Bounds(bounds) => SeenBounds::of_boxes([bounds]),
            Region::Everything => SeenBounds::of_boxes(input.receivers),
            Region::Cameras(cameras) => visible::find(cameras, input.receivers, &mut scratch.seen),
        };
        scratch.casters.clear();
        scratch
            .casters
            .extend(input.casters.iter().map(|bounds| CasterBounds {
                light: input.axes.light_box(bounds, input.origin),
                can_shadow: !bounds.is_empty()
                    && can_shadow(bounds, &visible, input.axes.toward_light()),
            }));
        let any_casts = scratch.casters.iter().any(|caster| caster.can_shadow);
        let mut next = self.clone();
        for cascade in 0..limits.cascades {
            let slice = camera_slice(input, limits, &visible, cascade);
            let required = required_box(input, limits, slice.as_ref(), &scratch.seen, cascade);
            let held = self.held[cascade].as_ref();
            let light_bounds = match required {
                Some(required) if any_casts => {
                    let spacing = checked_spacing(input, limits, slice.as_ref(), &required)?;
                    fit_bounds(input, limits, &scratch.casters, (required, spacing), held)
                }
                _ => None,
            };
            next.held[cascade] = light_bounds.or(next.held[cascade]);
            next.light_bounds[cascade] = light_bounds;
            next.slices[cascade] = slice.zip(light_bounds).map(|(slice, light_bounds)| {
                let scratch = &mut scratch.footprint;
                slice.report(&input.axes, input.origin, &light_bounds.rect, scratch)
            });
        }
        Ok(next)
    }

    /// Returns the light-space bounds of a cascade that something casts into, and adds its casters to `drawn`: those of
    /// which some part is within the map rectangle, seen along the light, and in front of the far plane. `scratch` is
    /// the one that the fit has filled.
    pub fn cull(
        &self,
        cascade: usize,
        input: &FitInput<'_>,
        scratch: &FitScratch,
        drawn: &mut Vec<u32>,
    ) -> Option<&LightSpaceBounds> {
        let light_bounds = self.light_bounds[cascade].as_ref()?;
        let spacing = Spacing::around(input.origin, &light_bounds.bounds());
        let volume = ExtrudedRect::new(&input.axes, input.origin, &light_bounds.rect);
        let all = (0u32..).zip(scratch.casters.iter().zip(input.casters));
        drawn.extend(all.filter_map(|(index, (caster, bounds))| {
            let casts_into_bounds = caster.can_shadow
                && light_bounds.holds_part_of(&caster.widest_light(spacing))
                && volume.meets(bounds);
            casts_into_bounds.then_some(index)
        }));
        Some(light_bounds)
    }
}

/// Returns how finely f64 distinguishes positions in `required`, if that is fine enough for the map of a cascade.
fn checked_spacing(
    input: &FitInput<'_>,
    limits: &FitLimits,
    slice: Option<&Slice<'_>>,
    required: &LightBox,
) -> Result<Spacing, ShadowError> {
    let spacing = Spacing::around(input.origin, required);
    let extent = || match slice {
        // This is the extent of the slice, not of what is seen: that may be a corner of an object, which needs no finer
        // texels than the rest of the image.
        Some(slice) if limits.stability == Stability::TightFit => {
            let (depth_near, depth_far) = slice.between;
            let sphere = slice.camera.slice_sphere(depth_near, depth_far);
            (2.0 * sphere.radius).min(widest_given(input))
        }
        _ => required.widest_side(),
    };
    let floor = texel_floor(input, required, required.max.z);
    let distance = render_reach(input, required, required.max.z);
    spacing.checked(extent, limits.map_size, floor, distance)
}

/// Returns the wider side, seen from the light, of all casters and receivers of the frame together.
fn widest_given(input: &FitInput<'_>) -> f64 {
    let given = input.casters.iter().chain(input.receivers);
    let given = given
        .filter(|bounds| !bounds.is_empty())
        .fold(Aabb::EMPTY, |all, bounds| all.union(*bounds));
    input.axes.light_box(&given, DVec3::ZERO).widest_side()
}

/// Returns cascade `cascade` of the first camera's view. Returns `None` without a camera, or where its depths contain
/// nothing. All cameras are divided at the same depths.
fn camera_slice<'a>(
    input: &FitInput<'a>,
    limits: &FitLimits,
    visible: &'a SeenBounds,
    cascade: usize,
) -> Option<Slice<'a>> {
    let Region::Cameras(cameras) = input.region else {
        return None;
    };
    let camera = cameras.first()?;
    let (near, far) = match limits.stability {
        Stability::TightFit => (visible.depth_near, visible.depth_far),
        Stability::BoundingSphere => {
            let ranges = cameras.iter().map(CameraFrustum::depth_range);
            ranges.fold((f64::INFINITY, f64::NEG_INFINITY), |all, range| {
                (all.0.min(range.0), all.1.max(range.1))
            })
        }
    };
    let end = |index| limits.split.depth(index, limits.cascades, near, far);
    let between = (end(cascade), end(cascade + 1));
    // An explicit end before all that is seen leaves its cascade empty.
    let is_empty = between.0 == between.1 && near < far;
    (!is_empty).then_some(Slice {
        camera,
        visible,
        between,
    })
}

/// Returns the light-space box of the receivers that cascade `cascade` is for, or `None` where there are none.
fn required_box(
    input: &FitInput<'_>,
    limits: &FitLimits,
    slice: Option<&Slice<'_>>,
    seen: &[Seen],
    cascade: usize,
) -> Option<LightBox> {
    let mut required = LightBox::EMPTY;
    let of_box = |bounds: &Aabb| input.axes.light_box(bounds, input.origin);
    match input.region {
        Region::Bounds(bounds) if cascade == 0 && !bounds.is_empty() => {
            required = of_box(&bounds);
        }
        Region::Everything if cascade == 0 => {
            let receivers = input.receivers.iter().filter(|bounds| !bounds.is_empty());
            receivers.for_each(|bounds| required.union(&of_box(bounds)));
        }
        Region::Bounds(_) | Region::Everything => {}
        Region::Cameras(cameras) => {
            let between = slice?.between;
            let (axes, origin) = (&input.axes, input.origin);
            for camera in cameras.iter().enumerate() {
                let seen = visible::light_box_between(camera, seen, between, axes, origin);
                if seen.is_empty() {
                    continue;
                }
                required.union(&match limits.stability {
                    Stability::TightFit => seen,
                    Stability::BoundingSphere => around_slice(input, camera.1, between, seen),
                });
            }
        }
    }
    (!required.is_empty()).then_some(required)
}

/// Returns a box with the depths of `seen` and the whole width of a slice's sphere.
fn around_slice(
    input: &FitInput<'_>,
    camera: &CameraFrustum,
    between: (f64, f64),
    seen: LightBox,
) -> LightBox {
    let sphere = camera.slice_sphere(between.0, between.1);
    let center = input.axes.light_from_world * (input.origin + sphere.center_render);
    LightBox {
        min: (center - sphere.radius).with_z(seen.min.z),
        max: (center + sphere.radius).with_z(seen.max.z),
    }
}

/// Returns whether a shadow of `caster` can fall on anything visible. A point is shadowed by a point of the caster
/// further along the way to the light, so on each world axis the caster must reach beyond the receivers' near end in
/// the light's direction. A flat floor under everything else fails this (it reaches just as far as the lowest receiver:
/// itself), and neither widens the light-space bounds nor is drawn.
fn can_shadow(caster: &Aabb, receivers: &SeenBounds, toward_light: DVec3) -> bool {
    let (low, high) = (caster.min.as_dvec3(), caster.max.as_dvec3());
    (0..3).all(|axis| {
        let toward = toward_light[axis];
        if toward > 0.0 {
            high[axis] > receivers.render_min[axis]
        } else if toward < 0.0 {
            low[axis] < receivers.render_max[axis]
        } else {
            high[axis] >= receivers.render_min[axis] && low[axis] <= receivers.render_max[axis]
        }
    })
}

/// Returns the light-space bounds for receivers in `required`: seen from the light, what both receivers and casters
/// cover. A caster counts as reaching the receivers where rounding makes that doubtful. Returns `None` where no caster
/// reaches them.
fn fit_bounds(
    input: &FitInput<'_>,
    limits: &FitLimits,
    casters: &[CasterBounds],
    (required, spacing): (LightBox, Spacing),
    held: Option<&LightSpaceBounds>,
) -> Option<LightSpaceBounds> {
    let reaches = |caster: &&CasterBounds| {
        let light = caster.widest_light(spacing);
        caster.can_shadow && light.max.z > required.min.z && light.overlaps_xy(&required)
    };
    let mut shadows = LightBox::EMPTY;
    for caster in casters.iter().filter(reaches) {
        shadows.union(&caster.light);
    }
    if shadows.is_empty() {
        return None;
    }
    let mut covered = required;
    let follows_casters = match input.region {
        Region::Bounds(_) => false,
        Region::Everything => true,
        Region::Cameras(_) => limits.stability == Stability::TightFit,
    };
    if follows_casters {
        covered.min = required.min.max(shadows.min).with_z(required.min.z);
        covered.max = required.max.min(shadows.max).max(covered.min);
    }
    covered.max.z = shadows.max.z.max(required.min.z);
    let texel_floor = texel_floor(input, &covered, required.max.z).max(spacing.finest_texel());
    let (min, max) = spacing.grown(
        (covered.min.truncate(), covered.max.truncate()),
        limits.map_size,
        texel_floor,
    );
    let request = MapRectRequest {
        min,
        max,
        map_size: limits.map_size,
        margin_texels: limits.margin_texels,
        texel_floor,
        full_half_side: f64::INFINITY,
    };
    let rect = MapRect::fit(&request, held.map(|held| &held.rect));
    let depth = |near| {
        let least = rect.texel.max_element().max(spacing.least_depth());
        DepthRange::fit(covered.min.z, near, least, held.map(|held| &held.depth))
    };
    let light_bounds = LightSpaceBounds {
        rect,
        depth: depth(covered.max.z),
    };
    // Only the part of a caster inside the extruded map rectangle counts for the near plane: the far end of a wide
    // ground does not. The quantized light-space bounds are larger than was requested, so this also takes in casters
    // that touch only their border.
    let mut over_rect = HalfSpaces::default();
    push_extruded_rect(&mut over_rect, &input.axes, input.origin, &rect);
    let mut nearest = covered.min.z;
    for (caster, bounds) in casters.iter().zip(input.casters) {
        let light = caster.widest_light(spacing);
        if caster.can_shadow && light.max.z > nearest && light_bounds.holds_part_of(&light) {
            over_rect.visit_vertices(bounds, |vertex| {
                let z = input.axes.toward_light().dot(input.origin + vertex);
                nearest = nearest.max(z);
            });
        }
    }
    Some(LightSpaceBounds {
        depth: depth(nearest),
        ..light_bounds
    })
}

/// Returns four ulps of f32 at the farthest render coordinate of what is covered, up to the highest receiver: texels
/// finer than receivers' positions would resolve nothing. The height of a caster above the receivers does not count.
fn texel_floor(input: &FitInput<'_>, covered: &LightBox, highest_receiver: f64) -> f64 {
    let reach = render_reach(input, covered, highest_receiver);
    4.0 * f64::from(f32::EPSILON) * reach.max(f64::from(f32::MIN_POSITIVE) * 1e8)
}

/// Returns the farthest render coordinate, along an axis of the light, of what is covered up to the highest receiver.
fn render_reach(input: &FitInput<'_>, covered: &LightBox, highest_receiver: f64) -> f64 {
    let origin_light = input.axes.light_from_world * input.origin;
    let highest = covered.max.with_z(highest_receiver);
    (covered.min - origin_light)
        .abs()
        .max((highest - origin_light).abs())
        .max_element()
}
