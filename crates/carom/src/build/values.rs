//! Numbers, vectors and places as scenarios give them and messages show them.

use carom_mesh::Vector;

use crate::error::InputError;

/// Checks that a number is finite and satisfies `valid`.
pub(crate) fn number(key: &str, value: f64, valid: bool, remedy: &str) -> Result<(), InputError> {
    if valid && value.is_finite() { Ok(()) } else { Err(InputError::new(key, format!("{value}: {remedy}"))) }
}

pub(crate) fn vector<const D: usize>(key: &str, values: &[f64]) -> Result<Vector<D>, InputError> {
    if values.len() != D {
        return Err(InputError::new(key, format!("{values:?} must have {D} components")));
    }
    if !values.iter().all(|v| v.is_finite()) {
        return Err(InputError::new(key, format!("{values:?} must be finite numbers")));
    }
    Ok(Vector::from_column_slice(values))
}

/// A place as messages show it.
pub(crate) fn place<const D: usize>(x: &Vector<D>) -> String {
    let components: Vec<String> = x.iter().map(|x| format!("{x:.6}")).collect();
    format!("({})", components.join(", "))
}
