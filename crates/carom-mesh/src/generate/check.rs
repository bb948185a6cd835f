//! What generators ask of their parameters.

use std::fmt::Debug;

use crate::MeshError;

/// The most cells a generator makes; more is a slip, and would exhaust the memory before anything else could say so.
const MAX_CELLS: f64 = 5e6;

/// Refuses a parameter that is not `valid`.
pub(super) fn check(
    valid: bool,
    parameter: &'static str,
    value: &dyn Debug,
    remedy: &'static str,
) -> Result<(), MeshError> {
    if valid {
        return Ok(());
    }
    Err(MeshError::Generator { parameter, value: format!("{value:?}"), remedy })
}

/// Refuses `divisions` that make more cells than [`MAX_CELLS`].
pub(super) fn check_size(cells: f64, divisions: &dyn Debug) -> Result<(), MeshError> {
    let remedy = "it would have more than 5 million cells; take fewer divisions";
    check(cells <= MAX_CELLS, "divisions", divisions, remedy)
}

/// Whether a number is a length.
pub(super) fn is_length(length: f64) -> bool {
    length.is_finite() && length > 0.0
}
