//! Functions of time on their own: where an obstacle that moves by a formula is.

use carom::{InputError, Signal, SignalSpec};
use numpy::{PyArray1, PyReadonlyArray1};
use pyo3::prelude::*;

use crate::error;

/// Values of a function of time at `times` [s]; `spec` is the function as JSON, as the scenario writes it.
///
/// # Errors
/// `InputError` if it is none.
#[pyfunction]
pub fn signal_values<'py>(
    py: Python<'py>,
    spec: &str,
    times: PyReadonlyArray1<'py, f64>,
) -> PyResult<Bound<'py, PyArray1<f64>>> {
    let refused = |message: String| error::input_error(py, &InputError::new("", message));
    let spec: SignalSpec = serde_json::from_str(spec).map_err(|error| refused(error.to_string()))?;
    let signal = Signal::new(&spec).map_err(|error| refused(error.to_string()))?;
    let values = times.as_array().iter().map(|&t| signal.at(t).value).collect();
    Ok(PyArray1::from_vec(py, values))
}
