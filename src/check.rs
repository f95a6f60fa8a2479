//! Validation shared by the lights: each failure names field, rule and value.

use std::fmt::Display;

use glam::DVec3;

use crate::{Aabb, Bias, CascadeSplit, Filter, ShadowError};

pub(crate) fn in_range(
    field: &'static str,
    rule: &'static str,
    holds: bool,
    value: impl Display,
) -> Result<(), ShadowError> {
    if holds {
        Ok(())
    } else {
        Err(ShadowError::OutOfRange {
            field,
            rule,
            value: value.to_string(),
        })
    }
}

/// Infinity allowed.
pub(crate) fn above_zero(field: &'static str, value: f32) -> Result<(), ShadowError> {
    in_range(field, "above 0 (infinity allowed)", value > 0.0, value)
}

pub(crate) fn finite_vector(field: &'static str, value: DVec3) -> Result<(), ShadowError> {
    if value.is_finite() {
        Ok(())
    } else {
        Err(ShadowError::NotFinite {
            field,
            value: value.to_string(),
        })
    }
}

pub(crate) fn direction(field: &'static str, value: DVec3) -> Result<(), ShadowError> {
    finite_vector(field, value)?;
    if value == DVec3::ZERO {
        return Err(ShadowError::ZeroDirection { field });
    }
    Ok(())
}

pub(crate) fn bounds(field: &'static str, index: usize, bounds: &Aabb) -> Result<(), ShadowError> {
    // Empty bounds stand for nothing and may be infinite; NaN compares false and is not empty.
    if bounds.is_empty() || bounds.is_finite() {
        return Ok(());
    }
    Err(ShadowError::BoundsNotFinite {
        field,
        index,
        value: format!("{}..{}", bounds.min, bounds.max),
    })
}

pub(crate) fn receiver_bounds(field: &'static str, list: &[Aabb]) -> Result<(), ShadowError> {
    list.iter()
        .enumerate()
        .try_for_each(|(index, item)| bounds(field, index, item))
}

/// A filter that a light with a single map plane at a time can use.
pub(crate) fn planar_filter(field: &'static str, planar: Filter) -> Result<(), ShadowError> {
    in_range(
        field,
        "a filter for all kinds of light (direction-space filters are for point lights)",
        planar.directions().is_none(),
        format_args!("{planar:?}"),
    )?;
    filter(field, planar)
}

pub(crate) fn filter(field: &'static str, filter: Filter) -> Result<(), ShadowError> {
    if filter.directions().is_some() {
        let radius = filter.radius_world();
        return in_range(
            field,
            "of a finite radius above 0",
            radius > 0.0 && radius.is_finite(),
            radius,
        );
    }
    if let Filter::Penumbra { light_size } | Filter::PenumbraTurned { light_size } = filter {
        return in_range(
            field,
            "of a finite light size above 0",
            light_size > 0.0 && light_size.is_finite(),
            light_size,
        );
    }
    let sharpness = filter.sharpness();
    in_range(
        field,
        "of a finite sharpness of at least 1",
        sharpness >= 1.0 && sharpness.is_finite(),
        sharpness,
    )
}

pub(crate) fn bias(field: &'static str, bias: Bias) -> Result<(), ShadowError> {
    let (constant, slope) = bias.manual();
    let valid = |value: f32| value >= 0.0 && value.is_finite();
    in_range(
        field,
        "of finite constant and slope of at least 0",
        valid(constant) && valid(slope),
        format_args!("constant {constant}, slope {slope}"),
    )
}

pub(crate) fn split(
    field: &'static str,
    split: CascadeSplit,
    cascades: u32,
) -> Result<(), ShadowError> {
    let lambda = match split {
        CascadeSplit::Practical { lambda } => lambda,
        CascadeSplit::Uniform | CascadeSplit::Logarithmic => 1.0,
        CascadeSplit::Explicit { ends } => {
            let ends = &ends[..cascades as usize - 1];
            let finite = ends.iter().all(|end| end.is_finite());
            return in_range(
                field,
                "of finite ends that grow",
                finite && ends.is_sorted_by(|before, after| before < after),
                format_args!("{ends:?}"),
            );
        }
    };
    in_range(
        field,
        "of a lambda in 0..=1",
        (0.0..=1.0).contains(&lambda),
        lambda,
    )
}
