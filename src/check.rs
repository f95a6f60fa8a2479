//! Validates the values that all kinds of lights take. Each failure names the field, the rule and
//! the value.

use std::fmt::Display;

use glam::DVec3;

use crate::{Aabb, ShadowError};

/// Accepts `value` where `holds` is true; `rule` states in words what `holds` tests.
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

/// Accepts numbers above 0, infinity included.
pub(crate) fn above_zero(field: &'static str, value: f32) -> Result<(), ShadowError> {
    in_range(field, "above 0 (infinity allowed)", value > 0.0, value)
}

/// Accepts vectors whose components are all finite.
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

/// Accepts finite vectors of any length but zero.
pub(crate) fn direction(field: &'static str, value: DVec3) -> Result<(), ShadowError> {
    finite_vector(field, value)?;
    if value == DVec3::ZERO {
        return Err(ShadowError::ZeroDirection { field });
    }
    Ok(())
}

/// Accepts bounds that are empty or finite.
pub(crate) fn bounds(field: &'static str, bounds: &Aabb) -> Result<(), ShadowError> {
    // Empty bounds contain nothing and may be infinite. Bounds with a NaN do not count as empty.
    if bounds.is_empty() || bounds.is_finite() {
        return Ok(());
    }
    Err(ShadowError::BoundsNotFinite {
        field,
        value: format!("{}..{}", bounds.min, bounds.max),
    })
}
