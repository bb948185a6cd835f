//! Native errors as the Python exceptions of `carom.errors`.

use carom::{InputError, PosedProblem, RunError, StepError};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::{arrays, friction};

/// An exception class of `carom.errors`.
fn class<'py>(py: Python<'py>, name: &str) -> PyResult<Bound<'py, PyAny>> {
    py.import("carom.errors")?.getattr(name)
}

/// `InputError` or `MeshError` with its key.
pub fn input_error(py: Python<'_>, error: &InputError) -> PyErr {
    let name = if error.is_mesh { "MeshError" } else { "InputError" };
    let message = if error.key.is_empty() {
        error.message.clone()
    } else {
        format!("{}: {}", error.key, error.message)
    };
    let make = || class(py, name)?.call1((message, error.key.as_str()));
    make().map_or_else(|e| e, PyErr::from_value)
}

/// `ConvergenceError` of a step that somebody else makes, with the contact problem that was posed last where that is what failed.
pub fn step_error<const D: usize>(
    py: Python<'_>,
    error: &StepError,
    posed: Option<PosedProblem<'_, D>>,
) -> PyErr {
    let make = || {
        let report = PyDict::new(py);
        report.set_item("reason", error.to_string())?;
        let contact = contact_problem(py, error, posed, &report)?;
        class(py, "ConvergenceError")?.call((error.to_string(), report), Some(&contact))
    };
    make().map_or_else(|e| e, PyErr::from_value)
}

/// The contact problem that could not be solved and its guess, if that is what failed; what its solver said joins the report.
fn contact_problem<'py, const D: usize>(
    py: Python<'py>,
    error: &StepError,
    posed: Option<PosedProblem<'_, D>>,
    report: &Bound<'py, PyDict>,
) -> PyResult<Bound<'py, PyDict>> {
    let contact = PyDict::new(py);
    if let (StepError::Friction { report: solve, .. }, Some(posed)) = (error, posed) {
        report.set_item("friction", friction::describe(py, solve)?)?;
        contact.set_item("problem", friction::to_python(py, posed.problem)?)?;
        contact.set_item("guess", arrays::vectors(py, posed.guess)?)?;
    }
    Ok(contact)
}

/// `ConvergenceError` with its report and, where that is what failed, the contact problem that was posed last; its cause is what a body of another code
/// `raised`.
pub fn run_error<const D: usize>(
    py: Python<'_>,
    error: &RunError,
    posed: Option<PosedProblem<'_, D>>,
    raised: Option<&PyErr>,
) -> PyErr {
    let message = match raised {
        Some(raised) => format!("{error}; a body of another code, or the engine, raised {raised}"),
        None => error.to_string(),
    };
    let make = || {
        let report = PyDict::new(py);
        report.set_item("time", error.time)?;
        report.set_item("time_step", error.time_step)?;
        report.set_item("halvings", error.halvings)?;
        report.set_item("reason", error.reason.to_string())?;
        let contact = contact_problem(py, &error.reason, posed, &report)?;
        class(py, "ConvergenceError")?.call((message, report), Some(&contact))
    };
    let made = make().map_or_else(|e| e, PyErr::from_value);
    made.set_cause(py, raised.map(|raised| raised.clone_ref(py)));
    made
}
