//! Determines which part of light space each cascade of a directional light must cover.

use glam::DVec3;

use crate::fit::axes::{LightBox, LightSpace};
use crate::fit::camera::CameraFrustum;
use crate::fit::directional_input::{FitInput, FitLimits, Region};
use crate::fit::footprint::Slice;
use crate::fit::map_rect::HeldDepth;
use crate::fit::spacing::Spacing;
use crate::fit::stability::Stability;
use crate::fit::visible::{self, Seen, SeenBounds};
use crate::{Aabb, ShadowError};

/// Returns how finely f64 distinguishes positions in `required`, if that is fine enough for the map
/// of a cascade.
pub(crate) fn checked_spacing(
    input: &FitInput<'_>,
    limits: &FitLimits,
    slice: Option<&Slice<'_>>,
    required: &LightBox,
) -> Result<Spacing, ShadowError> {
    let spacing = Spacing::around(input.space.origin, required);
    let extent = || match slice {
        // This is the extent of the slice and not of what is seen. That may be a corner of an
        // object, which needs no finer texels than the rest of the image.
        Some(slice) if limits.stability == Stability::TightFit => {
            let (depth_near, depth_far) = slice.between;
            let sphere = slice.camera.slice_sphere(depth_near, depth_far);
            (2.0 * sphere.radius).min(widest_given(input))
        }
        _ => required.widest_side(),
    };
    let floor = input.texel_floor(required, required.max.z);
    let distance = input.render_reach(required, required.max.z);
    spacing.checked(extent, limits.map_size, floor, distance)
}

/// Returns whether f64 is fine enough for [`checked_spacing`] wherever other casters and receivers
/// are.
pub(crate) fn is_fine(input: &FitInput<'_>, required: &LightBox) -> bool {
    let spacing = Spacing::around(input.space.origin, required);
    spacing.finest_texel() <= input.texel_floor(required, required.max.z)
}

/// Returns the wider side, seen from the light, of all casters and receivers of the frame together.
fn widest_given(input: &FitInput<'_>) -> f64 {
    let receivers = input.receivers;
    let casters = input.casters.iter().map(|(_, bounds)| bounds);
    let receivers = receivers.iter().map(|(bounds, _)| bounds);
    let given = casters
        .chain(receivers)
        .fold(Aabb::EMPTY, |all, bounds| all.union(*bounds));
    // Where the origin is does not matter for a side, and a distant one would cost its precision.
    let space = LightSpace {
        origin: DVec3::ZERO,
        ..input.space
    };
    space.bounds(&given).widest_side()
}

/// Returns cascade `cascade` of the first camera's view. Returns `None` without a camera, or where
/// its depths contain nothing. All cameras are divided at the same depths.
pub(crate) fn camera_slice<'a>(
    input: &FitInput<'a>,
    limits: &FitLimits,
    visible: &'a SeenBounds,
    held_depths: Option<&HeldDepth>,
    cascade: usize,
) -> Option<Slice<'a>> {
    let Region::Cameras(cameras) = input.region else {
        return None;
    };
    let camera = cameras.first()?;
    let (near, far) = match limits.stability {
        Stability::TightFit => (visible.depth_near, visible.depth_far),
        Stability::BoundingSphere => {
            let ranges = cameras
                .iter()
                .map(|camera| sphere_range(camera, held_depths));
            ranges.fold((f64::INFINITY, f64::NEG_INFINITY), |all, range| {
                (all.0.min(range.0), all.1.max(range.1))
            })
        }
    };
    let end = |index| limits.split.depth(index, limits.cascades, near, far);
    let between = (end(cascade), end(cascade + 1));
    // A cascade whose explicit end lies before everything that is seen is empty.
    let is_empty = between.0 == between.1 && near < far;
    (!is_empty).then_some(Slice {
        camera,
        visible,
        between,
    })
}

/// Returns the depths along the view that the spheres of a camera's slices must contain. The slices
/// of a perspective camera end where its volume ends, so that only the projection changes them. An
/// orthographic camera may be anywhere along its view, and its near and far planes do not bound the
/// scene closely: its slices end where the visible receivers end, in steps that change rarely.
fn sphere_range(camera: &CameraFrustum, held_depths: Option<&HeldDepth>) -> (f64, f64) {
    let (near, far) = camera.depth_range();
    match held_depths {
        Some(held) if camera.is_orthographic() => {
            (near.max(held.depth.far), far.min(held.depth.near))
        }
        _ => (near, far),
    }
}

/// Returns the depths along the view between which receivers are visible, in steps that change
/// rarely.
pub(crate) fn held_depths(visible: &SeenBounds, held: Option<&HeldDepth>) -> Option<HeldDepth> {
    let (near, far) = (visible.depth_near, visible.depth_far);
    let least = f64::EPSILON.sqrt() * near.abs().max(far.abs()).max(f64::MIN_POSITIVE);
    (near <= far && near.is_finite() && far.is_finite())
        .then(|| HeldDepth::fit(near, far, least, held))
}

/// Returns the light-space box of the receivers that cascade `cascade` is for, or `None` where
/// there are none.
pub(crate) fn required_box(
    input: &FitInput<'_>,
    limits: &FitLimits,
    slice: Option<&Slice<'_>>,
    seen: &[Seen],
    cascade: usize,
) -> Option<LightBox> {
    let mut required = LightBox::EMPTY;
    match input.region {
        Region::Bounds(bounds) if cascade == 0 && !bounds.is_empty() => {
            required = input.space.bounds(&bounds);
        }
        Region::Everything if cascade == 0 => {
            let receivers = input.receivers.iter();
            receivers.for_each(|(bounds, _)| required.union(&input.space.bounds(bounds)));
        }
        Region::Bounds(_) | Region::Everything => {}
        Region::Cameras(cameras) => {
            let between = slice?.between;
            for camera in cameras.iter().enumerate() {
                let seen = visible::light_box_between(camera, seen, between, &input.space);
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
    let center = input.space.point(sphere.center_render);
    LightBox {
        min: (center - sphere.radius).with_z(seen.min.z),
        max: (center + sphere.radius).with_z(seen.max.z),
    }
}
