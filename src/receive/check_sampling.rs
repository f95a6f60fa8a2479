//! Checks filters and biases. Each failure names the field, the rule and the value.

use crate::ShadowError;
use crate::check::in_range;
use crate::receive::{Bias, Filter};

/// Accepts valid filters that work within one view of a light: all but those for point lights only.
pub(crate) fn check_planar_filter(field: &'static str, planar: Filter) -> Result<(), ShadowError> {
    in_range(
        field,
        "a filter for all kinds of light (direction-space filters are for point lights)",
        planar.directions().is_none(),
        format_args!("{planar:?}"),
    )?;
    check_filter(field, planar)
}

/// Accepts filters whose parameters are in range.
pub(crate) fn check_filter(field: &'static str, filter: Filter) -> Result<(), ShadowError> {
    if filter.directions().is_some() {
        let radius = filter.radius_world();
        return in_range(
            field,
            "a filter with a finite radius above 0",
            radius > 0.0 && radius.is_finite(),
            radius,
        );
    }
    if let Filter::Pcss { light_size } | Filter::PcssRotated { light_size } = filter {
        return in_range(
            field,
            "a filter with a finite light size above 0",
            light_size > 0.0 && light_size.is_finite(),
            light_size,
        );
    }
    let sharpness = filter.sharpness();
    in_range(
        field,
        "a filter with a finite sharpness of at least 1",
        sharpness >= 1.0 && sharpness.is_finite(),
        sharpness,
    )
}

/// Accepts biases whose parameters are in range.
pub(crate) fn check_bias(field: &'static str, bias: Bias) -> Result<(), ShadowError> {
    let (constant, slope) = bias.manual();
    let valid = |value: f32| value >= 0.0 && value.is_finite();
    in_range(
        field,
        "a bias with a finite constant and slope of at least 0",
        valid(constant) && valid(slope),
        format_args!("constant {constant}, slope {slope}"),
    )
}

/// Accepts fractions, in 0..=1, of the distance over which shadows fade.
pub(crate) fn check_fade(field: &'static str, fade: f32) -> Result<(), ShadowError> {
    in_range(field, "in 0..=1", (0.0..=1.0).contains(&fade), fade)
}
