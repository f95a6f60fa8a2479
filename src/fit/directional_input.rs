//! Defines the input of the fit of a directional light.

use glam::DVec3;

use crate::Aabb;
use crate::fit::axes::{LightBox, LightSpace};
use crate::fit::boxes::Boxes;
use crate::fit::camera::CameraFrustum;
use crate::fit::split::{MAX_CASCADES, SplitRule};
use crate::fit::stability::Stability;
use crate::fit::texel_rect::TexelRect;
use crate::fit::visible::Receivers;

/// Selects the receivers that count.
#[derive(Clone, Copy)]
pub(crate) enum Region<'a> {
    /// Counts what any of these cameras sees of the receivers.
    Cameras(&'a [CameraFrustum]),
    /// Counts all that is inside a given box. The light-space bounds then cover the box, whatever
    /// the casters.
    Bounds(Aabb),
    /// Counts all receivers.
    Everything,
}

/// Holds the input of a frame.
pub(crate) struct FitInput<'a> {
    pub space: LightSpace,
    pub region: Region<'a>,
    /// Holds the bounds of what casts; empty ones cast nothing.
    pub casters: Boxes<'a>,
    pub receivers: Receivers<'a>,
}

/// Holds the settings that the light was made with.
#[derive(Clone, Copy, Debug)]
pub(crate) struct FitLimits {
    /// Counts the texels per side of a layer.
    pub map_size: u32,
    /// States that one layer is divided among at most `cascades` cascades, whose ends and
    /// rectangles are found in each frame in place of those given here.
    pub divides_layer: bool,
    pub margin_texels: u32,
    /// Is the height in texels, above a surface, below which the bias may leave a caster without
    /// its shadow.
    pub gap_texels: f64,
    pub cascades: usize,
    pub split: SplitRule,
    /// Holds the rectangle of each cascade in its layer.
    pub rects: [TexelRect; MAX_CASCADES],
    pub stability: Stability,
}

impl FitInput<'_> {
    /// Returns four ulps of f32 at the farthest render coordinate of what is covered, up to the
    /// highest receiver: texels finer than receivers' positions would resolve nothing. The height
    /// of a caster above the receivers does not count.
    pub(crate) fn texel_floor(&self, covered: &LightBox, highest_receiver: f64) -> f64 {
        let reach = self.render_reach(covered, highest_receiver);
        4.0 * f64::from(f32::EPSILON) * reach.max(f64::from(f32::MIN_POSITIVE) * 1e8)
    }

    /// Returns the farthest render coordinate, along an axis of the light, of what is covered up to
    /// the highest receiver.
    pub(crate) fn render_reach(&self, covered: &LightBox, highest_receiver: f64) -> f64 {
        let origin_light = self.space.point(DVec3::ZERO);
        let highest = covered.max.with_z(highest_receiver);
        (covered.min - origin_light)
            .abs()
            .max((highest - origin_light).abs())
            .max_element()
    }
}
