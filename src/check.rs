//! Validation shared by the lights: each failure names field, rule and value.

use std::fmt::Display;

use glam::DVec3;

use crate::{Aabb, ShadowError};

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

pub(crate) fn bounds(field: &'static str, bounds: &Aabb) -> Result<(), ShadowError> {
    // Empty bounds stand for nothing and may be infinite; NaN compares false and is not empty.
    if bounds.is_empty() || bounds.is_finite() {
        return Ok(());
    }
    Err(ShadowError::BoundsNotFinite {
        field,
        value: format!("{}..{}", bounds.min, bounds.max),
    })
}
