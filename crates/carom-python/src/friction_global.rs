//! Contact problems in the unknowns of the bodies: M, H, f, b and μ in, reactions and velocities out.

use carom_friction::{
    GlobalMethod, GlobalProblem, SingularMatrix, SolverKind, SparseColMat, StoppingRule, SymbolicSparseColMat,
};
use numpy::{PyArray1, PyReadonlyArray1, PyReadonlyArray2, PyUntypedArrayMethods};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::arrays;
use crate::friction::{block_rows, describe, guess, kind, stopping_rule, vectors};
use crate::threads::detached;

/// M and H in compressed columns, with f, b and μ: the arrays of `carom.friction.GlobalProblem`, checked there.
#[derive(FromPyObject)]
pub struct GlobalArrays<'py> {
    /// First entry of every column of M, and their number: shape [n_dof + 1].
    m_starts: PyReadonlyArray1<'py, i64>,
    /// Rows, ascending in every column.
    m_rows: PyReadonlyArray1<'py, i64>,
    m_values: PyReadonlyArray1<'py, f64>,
    /// H likewise: shape [n D + 1].
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
    fn dimension(&self) -> usize {
        self.b.shape()[1]
    }

    fn problem<const D: usize>(&self) -> PyResult<GlobalProblem<D>> {
        let (f, b, mu) = (self.f.as_slice()?, self.b.as_slice()?, self.mu.as_slice()?);
        if b.len() != mu.len() * D {
            return Err(does_not_fit());
        }
        Ok(GlobalProblem {
            m: columns(f.len(), f.len(), &self.m_starts, &self.m_rows, &self.m_values)?,
            h: columns(f.len(), b.len(), &self.h_starts, &self.h_rows, &self.h_values)?,
            f: f.to_vec(),
            b: vectors(b),
            mu: mu.to_vec(),
        })
    }
}

fn does_not_fit() -> PyErr {
    PyValueError::new_err("the arrays of a global contact problem do not fit together")
}

/// A sparse matrix of `rows` × `count` numbers.
fn columns(
    rows: usize,
    count: usize,
    starts: &PyReadonlyArray1<'_, i64>,
    indices: &PyReadonlyArray1<'_, i64>,
    values: &PyReadonlyArray1<'_, f64>,
) -> PyResult<SparseColMat<usize, f64>> {
    let (starts, indices, values) = (starts.as_slice()?, indices.as_slice()?, values.as_slice()?);
    let fits = starts.len() == count + 1
        && starts[0] == 0
        && starts.windows(2).all(|s| s[0] <= s[1])
        && starts[count] as usize == indices.len()
        && indices.len() == values.len()
        && indices.iter().all(|&i| (0..rows as i64).contains(&i))
        && starts.windows(2).all(|s| {
            let column = &indices[s[0] as usize..s[1] as usize];
            column.windows(2).all(|i| i[0] < i[1])
        });
    if !fits {
        return Err(does_not_fit());
    }
    let index = |a: &[i64]| a.iter().map(|&i| i as usize).collect();
    let pattern = SymbolicSparseColMat::new_checked(rows, count, index(starts), None, index(indices));
    Ok(SparseColMat::new(pattern, values.to_vec()))
}

fn singular(error: SingularMatrix) -> PyErr {
    PyValueError::new_err(error.to_string())
}

/// Solves M v = H r + f, w = Hᵀ v + b with Signorini's and Coulomb's laws from the guess in `reactions`.
#[pyfunction]
#[pyo3(signature = (problem, reactions, *, solver, method, tolerance, max_iterations, time_limit))]
#[expect(clippy::too_many_arguments, reason = "the keywords of a Python function")]
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
        .ok_or_else(|| PyValueError::new_err(format!("there is no global method named {method:?}")))?;
    match problem.dimension() {
        1 => solve::<1>(py, &problem, &reactions, method, solver, &rule),
        2 => solve::<2>(py, &problem, &reactions, method, solver, &rule),
        _ => solve::<3>(py, &problem, &reactions, method, solver, &rule),
    }
}

fn solve<'py, const D: usize>(
    py: Python<'py>,
    arrays: &GlobalArrays<'py>,
    reactions: &PyReadonlyArray2<'py, f64>,
    method: GlobalMethod,
    solver: SolverKind,
    rule: &StoppingRule,
) -> PyResult<Bound<'py, PyDict>> {
    let problem = arrays.problem::<D>()?;
    let mut r = guess(reactions, problem.len())?;
    let answer = detached(py, || problem.solve(&mut r, method, solver, rule)).map_err(singular)?;
    let out = describe(py, &answer.report)?;
    out.set_item("method", answer.method.name())?;
    out.set_item("reactions", arrays::vectors(py, &r)?)?;
    out.set_item("motions", arrays::vectors(py, &answer.motions)?)?;
    out.set_item("velocities", PyArray1::from_vec(py, answer.velocities))?;
    Ok(out)
}

/// The local form, W = Hᵀ M⁻¹ H in compressed block rows and q = Hᵀ M⁻¹ f + b, as keyword arguments of
/// `carom.friction.Problem.from_blocks`.
#[pyfunction]
pub fn condense_friction<'py>(py: Python<'py>, problem: GlobalArrays<'py>) -> PyResult<Bound<'py, PyDict>> {
    fn of<'py, const D: usize>(py: Python<'py>, arrays: &GlobalArrays<'py>) -> PyResult<Bound<'py, PyDict>> {
        let problem = arrays.problem::<D>()?;
        let local = detached(py, || problem.condense()).map_err(singular)?;
        let (starts, columns, blocks) = block_rows(py, &local.w)?;
        let out = PyDict::new(py);
        out.set_item("starts", starts)?;
        out.set_item("columns", columns)?;
        out.set_item("blocks", blocks)?;
        out.set_item("q", arrays::vectors(py, &local.q)?)?;
        Ok(out)
    }
    match problem.dimension() {
        1 => of::<1>(py, &problem),
        2 => of::<2>(py, &problem),
        _ => of::<3>(py, &problem),
    }
}
