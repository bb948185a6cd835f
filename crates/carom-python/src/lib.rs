//! The native module `carom._carom`: a class that takes a scenario as JSON and gives back numbers, one for contact in somebody
//! else's time loop, and functions for contact problems on their own.

mod arrays;
mod checkpoint;
mod dimension;
mod engine;
mod error;
mod foreign;
mod friction;
mod friction_global;
mod mesh;
mod planted;
mod signal;
mod simulation;
mod state;
mod threads;

use pyo3::prelude::*;

#[pymodule]
fn _carom(module: &Bound<'_, PyModule>) -> PyResult<()> {
    threads::watch_forks(module)?;
    module.add("__version__", env!("CARGO_PKG_VERSION"))?;
    module.add("CHECKPOINT_SCHEMA", carom::Checkpoint::SCHEMA)?;
    module.add_class::<simulation::Simulation>()?;
    module.add_class::<planted::PlantedContact>()?;
    module.add_class::<foreign::ForeignRun>()?;
    module.add_function(wrap_pyfunction!(threads::thread_count, module)?)?;
    module.add_function(wrap_pyfunction!(signal::signal_values, module)?)?;
    module.add_function(wrap_pyfunction!(friction::friction_solvers, module)?)?;
    module.add_function(wrap_pyfunction!(friction::solve_friction, module)?)?;
    module.add_function(wrap_pyfunction!(friction::measure_friction, module)?)?;
    module.add_function(wrap_pyfunction!(friction_global::solve_global_friction, module)?)?;
    module.add_function(wrap_pyfunction!(friction_global::condense_friction, module)?)
}
