//! Bodies that processes share, by an engine written in Python: see `carom.ranks`.

use std::sync::{Arc, Mutex, PoisonError};

use carom::Engine;
use carom_fem::{FemError, MatrixPart, RankSolver, Ranks, Share};
use numpy::{Element, PyArray1, PyArrayMethods, PyReadonlyArray1};
use pyo3::prelude::*;
use pyo3::types::{PyList, PySlice};

use crate::foreign::Calls;

/// A `carom.ranks.Engine`.
#[derive(Debug)]
pub struct PythonEngine {
    engine: Py<PyAny>,
    calls: Arc<Calls>,
}

impl PythonEngine {
    /// The one that was given, if one was.
    pub fn of(engine: Option<&Bound<'_, PyAny>>, calls: &Arc<Calls>) -> Option<Arc<dyn Engine>> {
        let engine = engine?.clone().unbind();
        Some(Arc::new(Self { engine, calls: Arc::clone(calls) }))
    }
}

impl Engine for PythonEngine {
    fn share(
        &self,
        body: &str,
        dimension: usize,
        nodes: &[f64],
        blocks: &[(usize, &[u32])],
    ) -> Result<Option<Share>, String> {
        let made = self.calls.noting(|py| {
            let nodes = PyArray1::from_slice(py, nodes).reshape([nodes.len() / dimension, dimension])?;
            let cells = PyList::empty(py);
            for &(width, connectivity) in blocks {
                let rows = connectivity.len() / width;
                cells.append(PyArray1::from_slice(py, connectivity).reshape([rows, width])?)?;
            }
            let part = self.engine.bind(py).call_method1("share", (body, nodes, cells))?;
            if part.is_none() {
                return Ok(None);
            }
            let owns: PyReadonlyArray1<'_, bool> = part.getattr("owns")?.extract()?;
            let owns: Arc<[bool]> = owns.as_array().iter().copied().collect();
            let is_first = part.getattr("is_first")?.extract()?;
            let (part, calls) = (part.unbind(), Arc::clone(&self.calls));
            let (double, single) = (Buffer::default(), Buffer::default());
            let ranks = Arc::new(Part { part, calls, is_first, double, single });
            Ok(Some(Share { ranks, owns }))
        });
        // The exception itself is told in place of this.
        made.ok_or_else(String::new)
    }
}

/// Numbers that are summed at once: an array that long is handed to Python again and again.
const AT_ONCE: usize = 1 << 16;

/// What an engine says of one body.
#[derive(Debug)]
struct Part {
    part: Py<PyAny>,
    calls: Arc<Calls>,
    is_first: bool,
    double: Buffer<f64>,
    single: Buffer<f32>,
}

/// The array of a kind of numbers, once there were any.
type Buffer<T> = Mutex<Option<Py<PyArray1<T>>>>;

impl Part {
    fn sum_with<T: Element + Copy>(&self, buffer: &Buffer<T>, nothing: T, values: &mut [T]) {
        let done = self.calls.noting(|py| {
            let mut kept = buffer.lock().unwrap_or_else(PoisonError::into_inner);
            let array =
                kept.get_or_insert_with(|| PyArray1::from_vec(py, vec![nothing; AT_ONCE]).unbind()).bind(py);
            for values in values.chunks_mut(AT_ONCE) {
                array.try_readwrite()?.as_slice_mut()?[..values.len()].copy_from_slice(values);
                let part = array.get_item(PySlice::new(py, 0, values.len() as isize, 1))?;
                self.part.bind(py).call_method1("sum", (part,))?;
                values.copy_from_slice(&array.try_readonly()?.as_slice()?[..values.len()]);
            }
            Ok(())
        });
        if done.is_none() {
            values.fill(nothing);
        }
    }
}

impl Ranks for Part {
    fn is_first(&self) -> bool {
        self.is_first
    }

    fn sum(&self, values: &mut [f64]) {
        self.sum_with(&self.double, f64::NAN, values);
    }

    fn sum_single(&self, values: &mut [f32]) {
        self.sum_with(&self.single, f32::NAN, values);
    }

    fn solver(&self) -> Box<dyn RankSolver> {
        let solver = self.calls.noting(|py| Ok(self.part.bind(py).call_method0("solver")?.unbind()));
        Box::new(Solver { solver, calls: Arc::clone(&self.calls), bytes: 0 })
    }
}

/// What an engine solves with; none after an exception.
#[derive(Debug)]
struct Solver {
    solver: Option<Py<PyAny>>,
    calls: Arc<Calls>,
    bytes: usize,
}

impl RankSolver for Solver {
    fn make(&mut self, part: &MatrixPart<'_>, exact: bool) -> Result<(), FemError> {
        let Some(solver) = &self.solver else { return Err(FemError::NotPositiveDefinite) };
        let made = self.calls.noting(|py| {
            let starts: Vec<i64> = part.starts.iter().map(|&start| start as i64).collect();
            let columns = PyArray1::from_slice(py, part.columns);
            let values = PyArray1::from_slice(py, part.values);
            let arguments = (part.dimension, PyArray1::from_vec(py, starts), columns, values, exact);
            let solver = solver.bind(py);
            let is_definite: bool = solver.call_method1("make", arguments)?.extract()?;
            Ok((is_definite, solver.getattr("bytes")?.extract()?))
        });
        match made {
            Some((true, bytes)) => {
                self.bytes = bytes;
                Ok(())
            }
            _ => Err(FemError::NotPositiveDefinite),
        }
    }

    fn solve(&mut self, x: &mut [f64]) {
        let solved = self.solver.as_ref().and_then(|solver| {
            self.calls.noting(|py| {
                let array = PyArray1::from_slice(py, x);
                solver.bind(py).call_method1("solve", (&array,))?;
                x.copy_from_slice(array.try_readonly()?.as_slice()?);
                Ok(())
            })
        });
        if solved.is_none() {
            x.fill(f64::NAN);
        }
    }

    fn bytes(&self) -> usize {
        self.bytes
    }
}
