//! Contact problems on their own: W, q and μ in, reactions out.

use std::time::Duration;

use carom_friction::{
    BlockMatrix, ContactProblem, Criterion, Matrix, SolveReport, SolverKind, StoppingRule, Vector, measure,
};
use numpy::{
    PyArray1, PyArray3, PyArrayMethods, PyReadonlyArray1, PyReadonlyArray2, PyReadonlyArray3,
    PyUntypedArrayMethods,
};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::arrays;
use crate::threads::detached;

/// W in compressed block rows, with q and μ: the arrays of `carom.friction.Problem`, checked there.
#[derive(FromPyObject)]
pub struct Arrays<'py> {
    /// First block of every row, and their number: shape [n + 1].
    starts: PyReadonlyArray1<'py, i64>,
    /// Block columns, ascending in every row.
    columns: PyReadonlyArray1<'py, i64>,
    /// Blocks, shape [blocks, D, D].
    blocks: PyReadonlyArray3<'py, f64>,
    /// Shape [n, D].
    q: PyReadonlyArray2<'py, f64>,
    /// Shape [n].
    mu: PyReadonlyArray1<'py, f64>,
}

impl Arrays<'_> {
    fn dimension(&self) -> usize {
        self.q.shape()[1]
    }

    fn problem<const D: usize>(&self) -> PyResult<ContactProblem<D>> {
        let wrong = || PyValueError::new_err("the arrays of a contact problem do not fit together");
        let (starts, columns) = (self.starts.as_slice()?, self.columns.as_slice()?);
        let (blocks, q, mu) = (self.blocks.as_slice()?, self.q.as_slice()?, self.mu.as_slice()?);
        let n = mu.len();
        let fits = starts.len() == n + 1
            && q.len() == n * D
            && blocks.len() == columns.len() * D * D
            && starts.windows(2).all(|s| s[0] <= s[1])
            && starts[0] == 0
            && starts[n] as usize == columns.len();
        if !fits {
            return Err(wrong());
        }
        let mut w = BlockMatrix::default();
        for i in 0..n {
            let row = starts[i] as usize..starts[i + 1] as usize;
            let ascending = columns[row.clone()].windows(2).all(|c| c[0] < c[1]);
            let inside = columns[row.clone()].iter().all(|&c| (0..n as i64).contains(&c));
            if !ascending || !inside || !columns[row.clone()].contains(&(i as i64)) {
                return Err(wrong());
            }
            w.push_row(row.map(|e| {
                let block = &blocks[e * D * D..(e + 1) * D * D];
                (columns[e] as usize, Matrix::from_fn(|a, b| block[a * D + b]))
            }));
        }
        Ok(ContactProblem { w, q: vectors(q), mu: mu.to_vec() })
    }
}

/// A problem as a `carom.friction.Problem`.
pub fn to_python<'py, const D: usize>(
    py: Python<'py>,
    problem: &ContactProblem<D>,
) -> PyResult<Bound<'py, PyAny>> {
    let (starts, columns, blocks) = block_rows(py, &problem.w)?;
    let (q, mu) = (arrays::vectors(py, &problem.q)?, PyArray1::from_slice(py, &problem.mu));
    py.import("carom.friction")?
        .getattr("Problem")?
        .call_method1("from_blocks", (starts, columns, blocks, q, mu))
}

/// First block of every row, block columns and blocks.
type BlockRows<'py> = (Bound<'py, PyArray1<i64>>, Bound<'py, PyArray1<i64>>, Bound<'py, PyArray3<f64>>);

/// W in compressed block rows.
pub fn block_rows<'py, const D: usize>(py: Python<'py>, w: &BlockMatrix<D>) -> PyResult<BlockRows<'py>> {
    let rows = || (0..w.row_count()).map(|i| w.row(i));
    let starts = rows().scan(0, |end, row| {
        *end += row.len() as i64;
        Some(*end)
    });
    let starts = PyArray1::from_iter(py, std::iter::once(0).chain(starts));
    let columns = PyArray1::from_iter(py, rows().flatten().map(|(column, _)| column as i64));
    // nalgebra stores a block by columns, NumPy by rows.
    let blocks: Vec<Matrix<D>> = rows().flatten().map(|(_, block)| block.transpose()).collect();
    let flat: &[f64] = bytemuck::cast_slice(&blocks);
    Ok((starts, columns, PyArray1::from_slice(py, flat).reshape([blocks.len(), D, D])?))
}

/// One vector for every D numbers.
pub fn vectors<const D: usize>(flat: &[f64]) -> Vec<Vector<D>> {
    flat.chunks_exact(D).map(Vector::from_column_slice).collect()
}

/// The solver of this name.
pub fn kind(name: &str) -> PyResult<SolverKind> {
    SolverKind::from_name(name)
        .ok_or_else(|| PyValueError::new_err(format!("there is no friction solver named {name:?}")))
}

/// When to stop, by either measure.
pub fn stopping_rule(
    tolerance: f64,
    max_iterations: usize,
    time_limit: Option<f64>,
) -> PyResult<StoppingRule> {
    let time_limit = time_limit
        .map(Duration::try_from_secs_f64)
        .transpose()
        .map_err(|e| PyValueError::new_err(format!("time_limit: {e}")))?;
    Ok(StoppingRule {
        tolerance,
        criterion: Criterion::Both,
        max_iterations,
        time_limit,
        ..StoppingRule::default()
    })
}

/// The names of all solvers, the default first.
#[pyfunction]
pub fn friction_solvers() -> Vec<&'static str> {
    SolverKind::ALL.iter().map(|k| k.name()).collect()
}

/// Solves w = W r + q with Signorini's and Coulomb's laws from the guess in `reactions`, which is overwritten.
#[pyfunction]
#[pyo3(signature = (problem, reactions, *, solver, tolerance, max_iterations, time_limit))]
#[expect(clippy::too_many_arguments, reason = "the keywords of a Python function")]
pub fn solve_friction<'py>(
    py: Python<'py>,
    problem: Arrays<'py>,
    reactions: PyReadonlyArray2<'py, f64>,
    solver: &str,
    tolerance: f64,
    max_iterations: usize,
    time_limit: Option<f64>,
) -> PyResult<Bound<'py, PyDict>> {
    let rule = stopping_rule(tolerance, max_iterations, time_limit)?;
    let kind = kind(solver)?;
    match problem.dimension() {
        1 => solve::<1>(py, &problem, &reactions, kind, &rule),
        2 => solve::<2>(py, &problem, &reactions, kind, &rule),
        _ => solve::<3>(py, &problem, &reactions, kind, &rule),
    }
}

fn solve<'py, const D: usize>(
    py: Python<'py>,
    arrays: &Arrays<'py>,
    reactions: &PyReadonlyArray2<'py, f64>,
    kind: SolverKind,
    rule: &StoppingRule,
) -> PyResult<Bound<'py, PyDict>> {
    let problem = arrays.problem::<D>()?;
    let mut r = guess(reactions, problem.len())?;
    let report = detached(py, || kind.solver().solve(&problem, &mut r, rule));
    let w: Vec<Vector<D>> = (0..r.len()).map(|i| problem.motion(i, &r)).collect();
    let out = describe(py, &report)?;
    out.set_item("reactions", arrays::vectors(py, &r)?)?;
    out.set_item("motions", arrays::vectors(py, &w)?)?;
    Ok(out)
}

/// Reactions to start from, one for each of `contacts`.
pub fn guess<const D: usize>(
    reactions: &PyReadonlyArray2<'_, f64>,
    contacts: usize,
) -> PyResult<Vec<Vector<D>>> {
    let r: Vec<Vector<D>> = vectors(reactions.as_slice()?);
    if r.len() != contacts || reactions.shape()[1] != D {
        return Err(PyValueError::new_err("the reactions do not fit the contact problem"));
    }
    Ok(r)
}

/// A report as a dictionary.
pub fn describe<'py>(py: Python<'py>, report: &SolveReport) -> PyResult<Bound<'py, PyDict>> {
    let out = PyDict::new(py);
    out.set_item("status", report.status.name())?;
    out.set_item("solver", report.solver.name())?;
    out.set_item("iterations", report.iterations)?;
    out.set_item("residual", report.measure.residual)?;
    out.set_item("natural_residual", report.measure.natural_residual)?;
    out.set_item("certificate", report.measure.certificate)?;
    out.set_item("time", report.time.as_secs_f64())?;
    let history: Vec<f64> = report.history.iter().flat_map(|s| [s.iteration as f64, s.residual]).collect();
    out.set_item("history", arrays::table(py, history, 2)?)?;
    Ok(out)
}

/// The residual in the problem's units, that in its natural ones, and the certificate [J] of given reactions.
#[pyfunction]
pub fn measure_friction(
    problem: Arrays<'_>,
    reactions: PyReadonlyArray2<'_, f64>,
) -> PyResult<(f64, f64, f64)> {
    fn of<const D: usize>(
        arrays: &Arrays<'_>,
        reactions: &PyReadonlyArray2<'_, f64>,
    ) -> PyResult<(f64, f64, f64)> {
        let problem = arrays.problem::<D>()?;
        let m = measure(&problem, &guess(reactions, problem.len())?);
        Ok((m.residual, m.natural_residual, m.certificate))
    }
    match problem.dimension() {
        1 => of::<1>(&problem, &reactions),
        2 => of::<2>(&problem, &reactions),
        _ => of::<3>(&problem, &reactions),
    }
}
