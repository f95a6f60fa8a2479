//! Bounds how far f32 arithmetic may take a receiver from its CPU reference in f64, term by term.
//!
//! With u = 2^-24, a sum of k products in f32 errs by at most k·u times the sum of their magnitudes to first order,
//! fused or not. Every bound below has that form, with the counts of `wgsl/view.wgsl` and `wgsl/bias_*.wgsl` rounded
//! up: 6 where a row of a matrix is multiplied by a vector (four products, and one rounding each for the vector's own
//! entries and for the division by w, which is one).

use glam::{DVec2, DVec3, Vec3};
use wgpu_shadows::reference::Receiver;
use wgpu_shadows::{Bias, Filter, ShadowViewUniform};

use crate::support::view_member::{member, plane_rows, texel_from_anchor};

/// Is the unit roundoff of f32.
pub const U: f64 = 1.0 / (1u64 << 24) as f64;

/// Bounds the errors of a receiver.
#[derive(Clone, Copy, Debug)]
pub struct Band {
    pub texel: DVec2,
    pub depth: f64,
    pub gradient: DVec2,
}

/// Returns the band of the receiver that `bias` makes of `position` and `normal`, both as f32 values; `None` where the
/// receiver is so nearly edge-on that its gradient has no significant digit.
pub fn band(
    view: &ShadowViewUniform,
    filter: Filter,
    bias: Bias,
    position: DVec3,
    normal: DVec3,
    receiver: &Receiver,
) -> Option<Band> {
    let number = |name| f64::from(member::<f32>(view, name));
    let relative = position - Vec3::from_array(member(view, "anchor")).as_dvec3();
    let rows = plane_rows(view);
    let homogeneous = normal.extend(-normal.dot(relative));
    let magnitude = normal.abs().extend(2.0 * normal.abs().dot(relative.abs()));
    let plane = DVec3::from_array(rows.map(|row| row.dot(homogeneous)));
    let plane_error = DVec3::from_array(rows.map(|row| 6.0 * U * row.abs().dot(magnitude)));
    // This is how far the bias moves the receiver in world units, and the error of that.
    let (moved, moved_error) = match bias {
        // This is a product of three factors, one of them a sum of two plane components.
        Bias::Auto | Bias::NormalOffset => {
            let texels = number("offset_texels");
            let moved = texels * (plane.x.abs() + plane.y.abs()) + number("mapping.rounding");
            (
                moved,
                texels * (plane_error.x + plane_error.y) + 6.0 * U * moved,
            )
        }
        // This is a normalisation (a reciprocal root within two ulps), a product, and the cosine's own four roundings.
        _ => {
            let moved = number("manual_constant") + 2.0 * number("manual_slope");
            (moved, 16.0 * U * moved)
        }
    };
    let reach = relative.abs() + DVec3::splat(moved);
    let position_error = 2.0 * U * reach + DVec3::splat(moved_error);
    let matrix = texel_from_anchor(view);
    let place_error = |row: usize| {
        let row = matrix.row(row).abs();
        6.0 * U * row.dot(reach.extend(1.0)) + row.truncate().dot(position_error)
    };
    let texel = DVec2::new(place_error(0), place_error(1));
    let follows = matches!(bias, Bias::Auto) && filter.compares_each_texel();
    let gradient = if follows {
        // This is a quotient: the errors of both sides, relative to the divisor.
        let divisor = plane.z.abs() - plane_error.z;
        if divisor <= 0.0 {
            return None;
        }
        let steep = receiver.gradient.abs();
        (plane_error.truncate() + steep * plane_error.z) / divisor + steep * (2.0 * U)
    } else {
        DVec2::ZERO
    };
    // The slack for rounding is itself a product and a sum.
    let lateral = number("lateral_error");
    let steep = receiver.gradient.abs().element_sum();
    let slack = lateral * gradient.element_sum() + 6.0 * U * (lateral * steep + 1.0);
    Some(Band {
        texel,
        depth: place_error(2) + slack,
        gradient,
    })
}

impl Band {
    /// Returns the error of the reference depth at the farthest texel of the kernel: the receiver's own, the gradient's
    /// over the kernel's reach, that of the position from which the gradient starts, and four roundings of the sum.
    pub fn reference_depth(&self, filter: Filter, receiver: &Receiver) -> f64 {
        let reach = filter.reach_texels() + 0.5;
        let steep = receiver.gradient.abs();
        self.depth
            + self.gradient.element_sum() * reach
            + steep.dot(self.texel)
            + 4.0 * U * (receiver.depth.abs() + steep.element_sum() * reach)
    }
}
