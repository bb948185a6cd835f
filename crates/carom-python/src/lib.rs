//! The native module `carom._carom`: one class that takes a scenario as JSON and gives back numbers.

mod arrays;
mod error;
mod simulation;

use pyo3::prelude::*;

#[pymodule]
fn _carom(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add("__version__", env!("CARGO_PKG_VERSION"))?;
    module.add_class::<simulation::Simulation>()
}
