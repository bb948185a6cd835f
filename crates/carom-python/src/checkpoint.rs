//! Checkpoints as dictionaries of NumPy arrays: `float64` for numbers, `uint64` for counts.

use carom::Checkpoint;
use numpy::{PyArray1, PyReadonlyArray1};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyDict;

/// The arrays by name.
pub fn to_python<'py>(py: Python<'py>, checkpoint: &Checkpoint) -> PyResult<Bound<'py, PyDict>> {
    let out = PyDict::new(py);
    for (name, values) in &checkpoint.numbers {
        out.set_item(name, PyArray1::from_slice(py, values))?;
    }
    for (name, values) in &checkpoint.integers {
        out.set_item(name, PyArray1::from_slice(py, values))?;
    }
    Ok(out)
}

/// The checkpoint of these arrays.
pub fn from_python(arrays: &Bound<'_, PyDict>) -> PyResult<Checkpoint> {
    let mut checkpoint = Checkpoint::default();
    for (name, values) in arrays {
        let name: String = name.extract()?;
        if let Ok(numbers) = values.extract::<PyReadonlyArray1<'_, f64>>() {
            checkpoint.numbers.insert(name, numbers.as_array().to_vec());
        } else if let Ok(integers) = values.extract::<PyReadonlyArray1<'_, u64>>() {
            checkpoint.integers.insert(name, integers.as_array().to_vec());
        } else {
            return Err(PyValueError::new_err(format!(
                "{name}: neither float64 nor uint64 in one dimension"
            )));
        }
    }
    Ok(checkpoint)
}
