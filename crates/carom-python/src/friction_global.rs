//! Contact problems in the unknowns of the bodies: M, H, f, b and μ in, reactions and velocities out.

use carom_friction::{GlobalMethod, GlobalProblem, GlobalReport, SingularMatrix, SolverKind, StoppingRule};
use faer::sparse::{SparseColMat, SymbolicSparseColMat};
use numpy::{PyArray1, PyArrayMethods, PyReadonlyArray1, PyReadonlyArray2, PyUntypedArrayMethods};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::arrays;
use crate::friction::{describe, guess, kind, stopping_rule, vectors};

/// M and H in compressed columns, with f, b and μ: the arrays of `carom.friction.GlobalProblem`, checked there.
#[derive(FromPyObject)]
pub struct GlobalArrays<'py> {
    /// First entry of every column of M, and their number: shape [n_dof + 1].
    m_starts: PyReadonlyArray1<'py, i64>,
    m_rows: PyReadonlyArray1<'py, i64>,
    m_values: PyReadonlyArray1<'py, f64>,
    /// The same of H: shape [n D + 1].
    h_starts: PyReadonlyArray1<'py, i64>,
    h_rows: PyReadonlyArray1<'py, i64>,
    h_values: PyReadonlyArray1<'py, f64>,
    /// Shape [n_dof].
    f: PyReadonlyArray1<'py, f64>,
    /// Shape [n, D].
    b: PyReadonlyArray2<'py, f64>,
    /// Shape [n].
    mu: PyReadonlyArray1<'py, f64>,
}

impl GlobalArrays<'_> {
    fn problem<const D: usize>(&self) -> PyResult<GlobalProblem<D>> {
        let (f, mu) = (self.f.as_slice()?.to_vec(), self.mu.as_slice()?.to_vec());
        let b = vectors(self.b.as_slice()?);
        if b.len() != mu.len() {
            return Err(misfit());
        }
        let m = sparse(f.len(), f.len(), &self.m_starts, &self.m_rows, &self.m_values)?;
        let h = sparse(f.len(), D * mu.len(), &self.h_starts, &self.h_rows, &self.h_values)?;
        Ok(GlobalProblem { m, h, f, b, mu })
    }
}

fn misfit() -> PyErr {
    PyValueError::new_err("the arrays of a global contact problem do not fit together")
}

fn sparse(
    rows: usize,
    columns: usize,
    starts: &PyReadonlyArray1<'_, i64>,
    indices: &PyReadonlyArray1<'_, i64>,
    values: &PyReadonlyArray1<'_, f64>,
) -> PyResult<SparseColMat<usize, f64>> {
    let (starts, indices, values) = (starts.as_slice()?, indices.as_slice()?, values.as_slice()?);
    let fits = starts.len() == columns + 1
        && starts[0] == 0
        && starts.windows(2).all(|s| s[0] <= s[1])
        && starts[columns] as usize == indices.len()
        && indices.len() == values.len()
        && indices.iter().all(|&i| (0..rows as i64).contains(&i))
        && starts
            .windows(2)
            .all(|s| indices[s[0] as usize..s[1] as usize].windows(2).all(|pair| pair[0] < pair[1]));
    if !fits {
        return Err(misfit());
    }
    let unsigned = |v: &[i64]| v.iter().map(|&k| k as usize).collect::<Vec<_>>();
    let pattern = SymbolicSparseColMat::new_checked(rows, columns, unsigned(starts), None, unsigned(indices));
    Ok(SparseColMat::new(pattern, values.to_vec()))
}

fn singular(error: SingularMatrix) -> PyErr {
    PyValueError::new_err(error.to_string())
}

/// Solves M v = H r + f, w = Hᵀ v + b with Signorini's and Coulomb's laws from the guess in `reactions`.
#[pyfunction]
#[pyo3(signature = (problem, reactions, *, solver, method, tolerance, max_iterations, time_limit))]
#[allow(clippy::too_many_arguments)]
pub fn solve_global_friction<'py>(
    py: Python<'py>,
    problem: GlobalArrays<'py>,
    reactions: PyReadonlyArray2<'py, f64>,
    solver: &str,
    method: &str,
    tolerance: f64,
    max_iterations: usize,
    time_limit: Option<f64>,
) -> PyResult<Bound<'py, PyDict>> {
    let rule = stopping_rule(tolerance, max_iterations, time_limit)?;
    let solver = kind(solver)?;
    let method = GlobalMethod::from_name(method)
        .ok_or_else(|| PyValueError::new_err(format!("there is no method named {method:?}")))?;
    match problem.b.shape()[1] {
        1 => solve::<1>(py, &problem, &reactions, solver, method, &rule),
        2 => solve::<2>(py, &problem, &reactions, solver, method, &rule),
        _ => solve::<3>(py, &problem, &reactions, solver, method, &rule),
    }
}

fn solve<'py, const D: usize>(
    py: Python<'py>,
    arrays: &GlobalArrays<'py>,
    reactions: &PyReadonlyArray2<'py, f64>,
    solver: SolverKind,
    method: GlobalMethod,
    rule: &StoppingRule,
) -> PyResult<Bound<'py, PyDict>> {
    let problem = arrays.problem::<D>()?;
    let mut r = guess(reactions, problem.len())?;
    let GlobalReport { report, method, velocities, motions } =
        py.detach(|| problem.solve(&mut r, method, solver, rule)).map_err(singular)?;
    let out = describe(py, &report)?;
    out.set_item("method", method.name())?;
    out.set_item("velocities", PyArray1::from_vec(py, velocities))?;
    out.set_item("reactions", arrays::vectors(py, &r)?)?;
    out.set_item("motions", arrays::vectors(py, &motions)?)?;
    Ok(out)
}

/// W in compressed block rows and q.
#[pyfunction]
pub fn condense_friction<'py>(py: Python<'py>, problem: GlobalArrays<'py>) -> PyResult<Bound<'py, PyDict>> {
    match problem.b.shape()[1] {
        1 => condense::<1>(py, &problem),
        2 => condense::<2>(py, &problem),
        _ => condense::<3>(py, &problem),
    }
}

fn condense<'py, const D: usize>(
    py: Python<'py>,
    arrays: &GlobalArrays<'py>,
) -> PyResult<Bound<'py, PyDict>> {
    let problem = arrays.problem::<D>()?;
    let local = py.detach(|| problem.condense()).map_err(singular)?;
    let (mut starts, mut columns, mut blocks) = (vec![0i64], Vec::new(), Vec::new());
    for i in 0..local.len() {
        for (column, block) in local.w.row(i) {
            columns.push(column as i64);
            blocks.extend((0..D * D).map(|e| block[(e / D, e % D)]));
        }
        starts.push(columns.len() as i64);
    }
    let out = PyDict::new(py);
    let count = columns.len();
    out.set_item("starts", PyArray1::from_vec(py, starts))?;
    out.set_item("columns", PyArray1::from_vec(py, columns))?;
    out.set_item("blocks", PyArray1::from_vec(py, blocks).reshape([count, D, D])?)?;
    out.set_item("q", arrays::vectors(py, &local.q)?)?;
    Ok(out)
}
