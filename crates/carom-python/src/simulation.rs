use std::sync::Arc;
use std::time::Instant;

use carom::{Inputs, Outcome, Scenario};
use carom_mesh::Vector;
use numpy::{PyArray1, PyArray2, PyReadonlyArray2};
use pyo3::exceptions::{PyIndexError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use serde::Serialize;

use crate::dimension::{Dimension, with};
use crate::engine::PythonEngine;
use crate::error::{input_error, run_error};
use crate::foreign::{Calls, is_error, laws};
use crate::threads::detached;
use crate::{arrays, checkpoint, mesh, state};

/// Wall time between two looks for Ctrl-C [s]; a step that takes longer is followed by one.
const SIGNAL_INTERVAL: f64 = 0.02;

/// A scenario built into meshes, matrices and a state that steps through time.
#[pyclass(module = "carom._carom")]
pub struct Simulation {
    inner: Dimension<carom::Simulation<2>, carom::Simulation<3>>,
    calls: Arc<Calls>,
}

/// Signed distances [m] and normals of points.
type Gaps<'py> = (Bound<'py, PyArray1<f64>>, Bound<'py, PyArray2<f64>>);

/// A serialisable value as Python objects.
fn to_python<'py>(py: Python<'py>, value: &impl Serialize) -> PyResult<Bound<'py, PyAny>> {
    let json = serde_json::to_string(value).map_err(|e| PyValueError::new_err(e.to_string()))?;
    py.import("json")?.call_method1("loads", (json,))
}

#[pymethods]
impl Simulation {
    #[new]
    #[pyo3(signature = (scenario, meshes=None, surfaces=None, foreign=None, engine=None))]
    fn new(
        py: Python<'_>,
        scenario: &str,
        meshes: Option<&Bound<'_, PyDict>>,
        surfaces: Option<&Bound<'_, PyDict>>,
        foreign: Option<&Bound<'_, PyDict>>,
        engine: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<Self> {
        let scenario: Scenario = serde_json::from_str(scenario)
            .map_err(|e| input_error(py, &carom::InputError::new("", format!("not a scenario: {e}"))))?;
        let calls = Arc::new(Calls::default());
        let inner = match scenario.dimension {
            3 => {
                let inputs = Inputs {
                    meshes: mesh::meshes(py, meshes)?,
                    surfaces: mesh::surfaces(surfaces)?,
                    laws: laws(foreign, &calls)?,
                    engine: PythonEngine::of(engine, &calls),
                };
                detached(py, || carom::Simulation::with_inputs(&scenario, inputs)).map(Dimension::Space)
            }
            // No surface is an obstacle of the plane: the build refuses what says so.
            _ => {
                let (meshes, laws) = (mesh::meshes(py, meshes)?, laws(foreign, &calls)?);
                let engine = PythonEngine::of(engine, &calls);
                let inputs = Inputs { laws, engine, ..Inputs::from(meshes) };
                detached(py, || carom::Simulation::with_inputs(&scenario, inputs)).map(Dimension::Plane)
            }
        };
        if let Some(error) = calls.take_error() {
            return Err(error);
        }
        Ok(Self { inner: inner.map_err(|e| input_error(py, &e))?, calls })
    }

    #[getter]
    fn time(&self) -> f64 {
        with!(&self.inner, run => run.time())
    }

    #[getter]
    fn step(&self) -> u64 {
        with!(&self.inner, run => run.step())
    }

    /// Number of the present stage, from 0.
    #[getter]
    fn stage(&self) -> usize {
        with!(&self.inner, run => run.stage_number())
    }

    #[getter]
    fn steps(&self) -> u64 {
        with!(&self.inner, run => run.steps())
    }

    fn describe<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        with!(&self.inner, run => to_python(py, run.description()))
    }

    fn mesh<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        with!(&self.inner, run => {
            let model = run.model();
            let meshes = model.bodies.iter().map(|b| (b.first_node, b.body.mesh()));
            let grid = arrays::grid(py, &model.assembly.reference[..model.node_count()], meshes)?;
            // Most bodies are of one material, and what is read of them has nothing to tell.
            if model.bodies.iter().any(|b| b.body.materials().len() > 1) {
                let of_cells = model.bodies.iter().flat_map(|b| b.body.material_of_cells());
                grid.set_item("region", PyArray1::from_iter(py, of_cells.map(|number| number as i32)))?;
            }
            Ok(grid)
        })
    }

    /// Mass and stiffness of a body as it is drawn, as blocks of pairs of nodes: rows, columns,
    /// mass [kg], stiffness [N/m], and which displacements are held.
    fn matrices<'py>(&self, py: Python<'py>, body: usize) -> PyResult<Bound<'py, PyDict>> {
        with!(&self.inner, run => {
            let part = run.model().bodies.get(body).ok_or_else(|| PyIndexError::new_err(body))?;
            arrays::matrices(py, part)
        })
    }

    /// The strain energy [J] of a body without a past at displacements [m] of its nodes.
    fn strain_energy<'py>(&self, body: usize, displacement: PyReadonlyArray2<'py, f64>) -> PyResult<f64> {
        with!(&self.inner, run => {
            let part = run.model().bodies.get(body).ok_or_else(|| PyIndexError::new_err(body))?;
            Ok(part.body.strain_energy(&arrays::from_rows(&displacement, part.body.node_count())?))
        })
    }

    /// The vibrations of a reduced body at displacements [m] and velocities [m/s] of its nodes: ω [rad/s], kinetic and strain energy of each [J], and
    /// `rigid`, the energy of translation and rotation [J]. None of any other body.
    fn vibrations<'py>(
        &self,
        py: Python<'py>,
        body: usize,
        displacement: PyReadonlyArray2<'py, f64>,
        velocity: PyReadonlyArray2<'py, f64>,
    ) -> PyResult<Option<Bound<'py, PyDict>>> {
        with!(&self.inner, run => {
            let part = run.model().bodies.get(body).ok_or_else(|| PyIndexError::new_err(body))?;
            let count = part.body.node_count();
            let (u, v) = (arrays::from_rows(&displacement, count)?, arrays::from_rows(&velocity, count)?);
            part.vibrations(&u, &v).map(|own| arrays::vibrations(py, &own)).transpose()
        })
    }

    /// The centre of mass of every body where nothing has moved [m].
    fn centres_of_mass<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        with!(&self.inner, run => {
            let centres: Vec<_> =
                run.model().bodies.iter().map(|b| b.mean(b.body.mesh().nodes())).collect();
            arrays::vectors(py, &centres)
        })
    }

    /// Distances of points [m] from an obstacle where it has not moved, negative inside, and the normals there.
    fn obstacle_gaps<'py>(
        &self,
        py: Python<'py>,
        obstacle: usize,
        points: PyReadonlyArray2<'py, f64>,
    ) -> PyResult<Gaps<'py>> {
        with!(&self.inner, run => {
            let obstacles = &run.model().assembly.contact.obstacles;
            let obstacle = obstacles.get(obstacle).ok_or_else(|| PyIndexError::new_err(obstacle))?;
            let points = arrays::from_rows(&points, points.as_array().nrows())?;
            let unmoved = |_| Vector::zeros();
            let (gaps, normals): (Vec<_>, Vec<_>) = points.iter().map(|x| obstacle.gap(x, &unmoved)).unzip();
            Ok((PyArray1::from_vec(py, gaps), arrays::vectors(py, &normals)?))
        })
    }

    fn fields<'py>(&mut self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        with!(&mut self.inner, run => {
        run.complete();
        let fields = run.fields();
        let voigt = |tensor: &dyn Fn(usize) -> [f64; 6]| (0..fields.cells.len()).flat_map(tensor).collect();
        let six = [(0, 0), (1, 1), (2, 2), (0, 1), (1, 2), (0, 2)];
        let stress = voigt(&|c| six.map(|ij| fields.cells[c].stress[ij]));
        let strain = voigt(&|c| six.map(|ij| fields.cells[c].strain[ij]));
        let density = fields.cells.iter().map(|c| c.energy_density).collect();
        let plastic_strain = fields.cells.iter().map(|c| c.plastic_strain).collect();
        let out = PyDict::new(py);
        out.set_item("displacement", arrays::vectors(py, fields.displacement)?)?;
        out.set_item("velocity", arrays::vectors(py, fields.velocity)?)?;
        out.set_item("reaction", arrays::vectors(py, fields.reaction)?)?;
        out.set_item("stress", arrays::table(py, stress, 6)?)?;
        out.set_item("strain", arrays::table(py, strain, 6)?)?;
        out.set_item("energy_density", PyArray1::from_vec(py, density))?;
        out.set_item("plastic_strain", PyArray1::from_vec(py, plastic_strain))?;
        Ok(out)
        })
    }

    /// The facets that may touch others, as a grid on the points of `mesh`.
    fn surface<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        with!(&self.inner, run => {
            let model = run.model();
            let surfaces = model.bodies.iter().map(|b| (b.first_node, b.body.surface()));
            arrays::surface_grid(py, &model.assembly.reference[..model.node_count()], surfaces)
        })
    }

    fn surface_fields<'py>(&mut self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        with!(&mut self.inner, run => {
        run.complete();
        let fields = run.surface_fields();
        let out = PyDict::new(py);
        out.set_item("displacement", arrays::vectors(py, run.fields().displacement)?)?;
        out.set_item("friction_energy", PyArray1::from_vec(py, fields.friction_energy))?;
        out.set_item("slip", PyArray1::from_vec(py, fields.slip))?;
        out.set_item("pressure", PyArray1::from_vec(py, fields.pressure))?;
        out.set_item("area", PyArray1::from_vec(py, fields.area))?;
        Ok(out)
        })
    }

    /// The name of an entry of the ledger table: of a body or, after these, of a pair as "a|b".
    fn ledger_entry(&self, number: usize) -> String {
        with!(&self.inner, run => run.ledger_entry(number))
    }

    fn take_ledger<'py>(&mut self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        arrays::table(py, with!(&mut self.inner, run => run.take_ledger()), carom::LedgerTable::WIDTH)
    }

    /// The last step made, as its two states and its energy terms; None before the first.
    fn last_step<'py>(&mut self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyDict>>> {
        with!(&mut self.inner, run => {
        run.complete();
        let Some(step) = run.last_step() else { return Ok(None) };
        let out = PyDict::new(py);
        for (name, state) in [("start", step.start), ("end", step.end)] {
            out.set_item(name, state::arrays(py, run.model(), state)?)?;
        }
        out.set_item("blend", PyArray1::from_slice(py, step.blend))?;
        out.set_item("vibration", PyArray1::from_slice(py, step.vibration))?;
        for (name, forces) in ["landing", "settling"].into_iter().zip(&step.impulses) {
            out.set_item(name, arrays::vectors(py, forces)?)?;
        }
        out.set_item("ledger", to_python(py, &step.ledger)?)?;
        Ok(Some(out))
        })
    }

    /// The present state, see `state::arrays`.
    fn state<'py>(&mut self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        with!(&mut self.inner, run => {
            run.complete();
            state::arrays(py, run.model(), run.state())
        })
    }

    /// The energy terms since the start [J].
    fn ledger<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        with!(&self.inner, run => to_python(py, &run.books().total))
    }

    /// What the last nominal step says about itself.
    fn nominal_step<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        with!(&self.inner, run => to_python(py, run.nominal_step()))
    }

    /// Overwrites the velocities [m/s] of all nodes; ValueError once a step was made, or if they do not fit.
    fn set_initial_velocity(&mut self, py: Python<'_>, velocity: PyReadonlyArray2<'_, f64>) -> PyResult<()> {
        with!(&mut self.inner, run => {
            if run.step() > 0 {
                return Err(PyValueError::new_err("steps were made already"));
            }
            let velocity = arrays::from_rows(&velocity, run.model().node_count())?;
            detached(py, || run.set_initial_velocity(velocity));
        });
        Ok(())
    }

    /// Overwrites the displacements [m] of all nodes; ValueError once a step was made, or if they do not fit.
    fn set_initial_displacement(
        &mut self,
        py: Python<'_>,
        displacement: PyReadonlyArray2<'_, f64>,
    ) -> PyResult<()> {
        with!(&mut self.inner, run => {
            if run.step() > 0 {
                return Err(PyValueError::new_err("steps were made already"));
            }
            let displacement = arrays::from_rows(&displacement, run.model().node_count())?;
            detached(py, || run.set_initial_displacement(&displacement)).map_err(|e| input_error(py, &e))
        })
    }

    /// Starts from the state of another run's checkpoint; ValueError once a step was made, or if it does not fit.
    fn start_from(&mut self, py: Python<'_>, arrays: &Bound<'_, PyDict>) -> PyResult<()> {
        let checkpoint = checkpoint::from_python(arrays)?;
        let done = with!(&mut self.inner, run => {
            if run.step() > 0 {
                return Err(PyValueError::new_err("steps were made already"));
            }
            detached(py, || run.start_from(&checkpoint))
        });
        done.map_err(|e| PyValueError::new_err(e.to_string()))
    }

    fn history_columns(&self) -> Vec<String> {
        with!(&self.inner, run => run.history_columns().to_vec())
    }

    fn take_history<'py>(&mut self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        with!(&mut self.inner, run => {
            let width = run.history_columns().len();
            arrays::table(py, run.take_history(), width)
        })
    }

    /// Runs to `until` [s] or for `budget` seconds of wall time, one step at least; whether `until` is reached.
    fn advance(&mut self, py: Python<'_>, until: f64, budget: f64) -> PyResult<bool> {
        let Self { inner, calls } = self;
        with!(inner, run => advance(py, run, calls, (until, budget)))
    }

    /// All that it takes to go on from here, as arrays by name.
    fn checkpoint<'py>(&mut self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let made = with!(&mut self.inner, run => {
            run.complete();
            run.checkpoint()
        });
        checkpoint::to_python(py, &made.map_err(|e| PyValueError::new_err(e.to_string()))?)
    }

    /// Goes on from such arrays; ValueError if they are not of this scenario.
    fn restore(&mut self, py: Python<'_>, arrays: &Bound<'_, PyDict>) -> PyResult<()> {
        let checkpoint = checkpoint::from_python(arrays)?;
        let done = with!(&mut self.inner, run => detached(py, || run.restore(&checkpoint)));
        done.map_err(|e| PyValueError::new_err(e.to_string()))
    }

    fn finish(&mut self) {
        with!(&mut self.inner, run => run.finish());
    }

    /// Which bodies rest.
    fn resting(&self) -> Vec<bool> {
        with!(&self.inner, run => run.resting().to_vec())
    }

    fn progress<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        with!(&self.inner, run => to_python(py, &run.progress()))
    }

    fn summary<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        with!(&self.inner, run => to_python(py, &run.summary()))
    }
}

/// Runs to `until` [s] or for `budget` seconds of wall time, one step at least; whether `until` is reached.
fn advance<const D: usize>(
    py: Python<'_>,
    run: &mut carom::Simulation<D>,
    calls: &Calls,
    (until, budget): (f64, f64),
) -> PyResult<bool> {
    let (outcome, interrupt) = detached(py, || {
        let start = Instant::now();
        let mut last_look = 0.0;
        let mut interrupt = None;
        let outcome = run.go_to(until, || {
            let elapsed = start.elapsed().as_secs_f64();
            if elapsed - last_look >= SIGNAL_INTERVAL {
                last_look = elapsed;
                interrupt = Python::attach(|py| py.check_signals()).err();
            }
            interrupt.is_some() || elapsed >= budget
        });
        (outcome, interrupt)
    });
    let raised = calls.take_error();
    let interrupt =
        interrupt.or_else(|| raised.as_ref().filter(|e| !is_error(py, e)).map(|e| e.clone_ref(py)));
    if let Some(interrupt) = interrupt {
        return Err(interrupt);
    }
    // What a shorter step has got over is forgotten.
    Ok(outcome.map_err(|e| run_error(py, &e, run.posed_problem(), raised.as_ref()))? == Outcome::Reached)
}
