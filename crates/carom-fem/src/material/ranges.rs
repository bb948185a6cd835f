//! Checks of material constants.

use crate::FemError;

/// Refuses what is not a finite number.
pub(crate) fn finite(name: &'static str, value: f64) -> Result<(), FemError> {
    check(name, value, value.is_finite(), "must be a finite number")
}

/// Refuses what is not greater than zero.
pub(crate) fn positive(name: &'static str, value: f64, remedy: &'static str) -> Result<(), FemError> {
    check(name, value, value.is_finite() && value > 0.0, remedy)
}

/// Refuses what is less than zero.
pub(crate) fn not_negative(name: &'static str, value: f64, remedy: &'static str) -> Result<(), FemError> {
    check(name, value, value.is_finite() && value >= 0.0, remedy)
}

/// Refuses a value that is not `valid`.
pub(crate) fn check(
    name: &'static str,
    value: f64,
    valid: bool,
    remedy: &'static str,
) -> Result<(), FemError> {
    if valid { Ok(()) } else { Err(FemError::MaterialConstant { name, value, remedy }) }
}
