//! Bodies whose law is written in Python, in steps of carom.

use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Mutex};
use std::time::Instant;

use carom::{Blocks, ForeignCode, ForeignLaw, ForeignPart, ForeignSpec, Laws, Outline};
use carom_mesh::{Matrix, Vector};
use numpy::{PyArray1, PyReadonlyArray1, PyReadonlyArray2, PyUntypedArrayMethods};
use pyo3::exceptions::{PyException, PyValueError};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple};

use crate::dimension::{Dimension, with};
use crate::error::{input_error, step_error};
use crate::planted::{facets_of, rows};
use crate::threads::detached;
use crate::{arrays, mesh};

/// What a call of a law led to: the first exception, and the time of all calls [ns].
#[derive(Debug, Default)]
pub(crate) struct Calls {
    failed: Mutex<Option<PyErr>>,
    time: AtomicU64,
}

impl Calls {
    /// The first exception since the last look.
    pub fn take_error(&self) -> Option<PyErr> {
        self.failed.lock().ok().and_then(|mut failed| failed.take())
    }

    /// Whether an exception waits that is no error: nothing is to be tried again.
    fn is_interrupted(&self, py: Python<'_>) -> bool {
        let failed = self.failed.lock();
        failed.is_ok_and(|failed| failed.as_ref().is_some_and(|e| !is_error(py, e)))
    }

    /// What a call returned, and its time; nothing after an exception, which is kept.
    pub fn noting<T>(&self, call: impl FnOnce(Python<'_>) -> PyResult<T>) -> Option<T> {
        let start = Instant::now();
        let answer = Python::attach(|py| if self.is_interrupted(py) { None } else { Some(call(py)) })?;
        self.time.fetch_add(start.elapsed().as_nanos() as u64, Ordering::Relaxed);
        match answer {
            Ok(answer) => Some(answer),
            Err(error) => {
                if let Ok(mut failed) = self.failed.lock() {
                    failed.get_or_insert(error);
                }
                None
            }
        }
    }
}

/// Whether an exception is an error, and not that of Ctrl-C.
pub fn is_error(py: Python<'_>, exception: &PyErr) -> bool {
    exception.is_instance_of::<PyException>(py)
}

/// The law of a body, as the methods of a `carom.foreign.ForeignBody` say it.
struct Law {
    body: Py<PyAny>,
    calls: Arc<Calls>,
}

impl Law {
    /// A method of the body at displacements of its nodes.
    fn ask<'py, const D: usize>(
        &self,
        py: Python<'py>,
        method: &str,
        u: &[Vector<D>],
    ) -> PyResult<Bound<'py, PyAny>> {
        self.body.bind(py).call_method1(method, (arrays::vectors(py, u)?,))
    }
}

impl<const D: usize> ForeignCode<D> for Law {
    fn energy(&self, u: &[Vector<D>]) -> f64 {
        self.calls.noting(|py| self.ask(py, "energy_at", u)?.extract()).unwrap_or(f64::NAN)
    }

    fn force(&self, u: &[Vector<D>], out: &mut [Vector<D>]) {
        let force = self.calls.noting(|py| {
            let force: PyReadonlyArray2<'_, f64> = self.ask(py, "force_at", u)?.extract()?;
            arrays::from_rows(&force, u.len())
        });
        match force {
            Some(force) => out.copy_from_slice(&force),
            None => out.fill(Vector::from_element(f64::NAN)),
        }
    }

    fn stiffness(&self, u: &[Vector<D>]) -> Option<Blocks<D>> {
        self.calls.noting(|py| blocks(&self.ask(py, "stiffness_at", u)?))
    }
}

/// The entries of a sparse matrix, given by rows, columns and values, as blocks of nodes.
fn blocks<const D: usize>(entries: &Bound<'_, PyAny>) -> PyResult<Blocks<D>> {
    type Entries<'py> = (PyReadonlyArray1<'py, i64>, PyReadonlyArray1<'py, i64>, PyReadonlyArray1<'py, f64>);
    let (rows, columns, values): Entries<'_> = entries.extract()?;
    let mut blocks: Blocks<D> = Vec::new();
    for ((&row, &column), &value) in rows.as_array().iter().zip(columns.as_array()).zip(values.as_array()) {
        let (row, column) = (row as usize, column as usize);
        let at = ((row / D) as u32, (column / D) as u32);
        match blocks.last_mut() {
            Some((a, b, block)) if (*a, *b) == at => block[(row % D, column % D)] += value,
            _ => {
                let mut block = Matrix::zeros();
                block[(row % D, column % D)] = value;
                blocks.push((at.0, at.1, block));
            }
        }
    }
    Ok(blocks)
}

/// Bodies of others on their way through time.
#[pyclass(module = "carom._carom")]
pub struct ForeignRun {
    inner: Dimension<carom::ForeignRun<2>, carom::ForeignRun<3>>,
    calls: Arc<Calls>,
}

/// What a `carom.foreign.ForeignBody` says of its mass and its law.
fn law<const D: usize>(body: &Bound<'_, PyAny>, calls: &Arc<Calls>) -> PyResult<ForeignLaw<D>> {
    let velocity: PyReadonlyArray2<'_, f64> = body.getattr("velocity")?.extract()?;
    let fixed: PyReadonlyArray2<'_, bool> = body.getattr("fixed")?.extract()?;
    let held = fixed.as_array().rows().into_iter().map(|row| std::array::from_fn(|i| row[i])).collect();
    Ok(ForeignLaw {
        velocity: arrays::from_rows(&velocity, velocity.shape()[0])?,
        held,
        mass: blocks(&body.getattr("mass_entries")?)?,
        code: Arc::new(Law { body: body.clone().unbind(), calls: Arc::clone(calls) }),
    })
}

/// Those of a dictionary with the names of bodies as keys.
pub fn laws<const D: usize>(given: Option<&Bound<'_, PyDict>>, calls: &Arc<Calls>) -> PyResult<Laws<D>> {
    let laws = given.into_iter().flatten();
    laws.map(|(name, body)| Ok((name.extract()?, law(&body, calls)?))).collect()
}

/// A body as `carom.foreign.ForeignBody` has it.
fn part<const D: usize>(body: &Bound<'_, PyAny>, calls: &Arc<Calls>) -> PyResult<ForeignPart<D>> {
    let points: PyReadonlyArray2<'_, f64> = body.getattr("points")?.extract()?;
    let surface = body.getattr("surface")?;
    let kinds: Vec<PyReadonlyArray2<'_, i64>> = surface.getattr("facets")?.extract()?;
    Ok(ForeignPart {
        outline: Outline {
            name: surface.getattr("name")?.extract()?,
            facets: facets_of(&kinds)?,
            touches_itself: surface.getattr("self_contact")?.extract()?,
        },
        points: rows(&points)?,
        law: law(body, calls)?,
    })
}

fn build<const D: usize>(
    py: Python<'_>,
    spec: &ForeignSpec,
    bodies: &[Bound<'_, PyAny>],
    files: carom::Surfaces<D>,
    calls: &Arc<Calls>,
) -> PyResult<carom::ForeignRun<D>> {
    let parts = bodies.iter().map(|body| part(body, calls)).collect::<PyResult<_>>()?;
    let run = detached(py, || carom::ForeignRun::build(spec, parts, files));
    calls.take_error().map_or_else(|| run.map_err(|e| input_error(py, &e)), Err)
}

#[pymethods]
impl ForeignRun {
    #[new]
    fn new(
        py: Python<'_>,
        spec: &str,
        bodies: &Bound<'_, PyTuple>,
        dimension: usize,
        files: Option<&Bound<'_, PyDict>>,
    ) -> PyResult<Self> {
        let spec: ForeignSpec =
            serde_json::from_str(spec).map_err(|e| PyValueError::new_err(format!("no run: {e}")))?;
        let calls = Arc::new(Calls::default());
        let bodies: Vec<Bound<'_, PyAny>> = bodies.iter().collect();
        let inner = match dimension {
            3 => Dimension::Space(build(py, &spec, &bodies, mesh::surfaces(files)?, &calls)?),
            _ => Dimension::Plane(build(py, &spec, &bodies, carom::Surfaces::new(), &calls)?),
        };
        Ok(Self { inner, calls })
    }

    /// Takes the bodies a step of this length [s] further and says what happened.
    fn step<'py>(&mut self, py: Python<'py>, time_step: f64) -> PyResult<Bound<'py, PyDict>> {
        let Self { inner, calls } = self;
        with!(inner, run => {
            let report = detached(py, || run.step(time_step));
            if let Some(error) = calls.take_error() {
                return Err(error);
            }
            let report = report.map_err(|e| step_error(py, &e, run.posed_problem()))?;
            let out = PyDict::new(py);
            let ledger = &report.ledger;
            out.set_item("friction", ledger.friction)?;
            out.set_item("normal_contact", ledger.normal_contact)?;
            out.set_item("prescribed", ledger.prescribed)?;
            out.set_item("scheme", ledger.scheme)?;
            out.set_item("defect", ledger.defect())?;
            out.set_item("certificate", report.certificate)?;
            out.set_item("min_gap", report.min_gap)?;
            out.set_item("pressing", report.contacts)?;
            out.set_item("iterations", report.newton_iterations)?;
            Ok(out)
        })
    }

    /// Time [s].
    #[getter]
    fn time(&self) -> f64 {
        with!(&self.inner, run => run.state().time)
    }

    /// Time that the laws have taken so far [s].
    #[getter]
    fn law_time(&self) -> f64 {
        self.calls.time.load(Ordering::Relaxed) as f64 * 1e-9
    }

    /// Kinetic and strain energy of every body [J], one after the other.
    #[getter]
    fn energies<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        with!(&self.inner, run => {
            PyArray1::from_iter(py, run.state().body_energies.iter().flat_map(|e| [e.kinetic, e.strain]))
        })
    }

    /// Displacements [m], velocities [m/s] and contact forces [N] of the nodes of a body.
    fn state<'py>(&self, py: Python<'py>, body: usize) -> PyResult<Bound<'py, PyDict>> {
        with!(&self.inner, run => {
            let (state, nodes) = (run.state(), run.assembly().nodes(body));
            let out = PyDict::new(py);
            out.set_item("displacement", arrays::vectors(py, &state.displacement[nodes.clone()])?)?;
            out.set_item("velocity", arrays::vectors(py, &state.velocity[nodes.clone()])?)?;
            out.set_item("contact_force", arrays::vectors(py, &state.contact_force[nodes])?)?;
            Ok(out)
        })
    }
}
