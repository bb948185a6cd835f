use faer::dyn_stack::{MemBuffer, StackReq};
use faer::sparse::{SparseColMat, SymbolicSparseColMat};
use nalgebra::DMatrix;

use super::control::CONTROL;
use crate::clock::Clock;
use crate::sparse_factor::{NoFactor, SparseFactor};

/// The inverse of M on one part.
pub(super) enum Factor {
    /// Of a few unknowns, such as those of a rigid body: written out.
    Small(DMatrix<f64>),
    /// Of many unknowns.
    Sparse(Box<SparseFactor>),
}

impl Factor {
    /// Factorises `m`; in case of failure gives the row where it is singular, or where its inverse has no correct digit.
    pub fn new(m: &SparseColMat<usize, f64>, symmetric: bool) -> Result<Self, usize> {
        // Without it there is no answer at all: whatever time it takes is spent.
        let clock = Clock::new(None);
        let empty = (0..m.ncols()).find(|&j| m.val_of_col(j).iter().all(|&v| v == 0.0));
        if let Some(row) = empty {
            return Err(row);
        }
        if m.ncols() <= CONTROL.small {
            return Factor::Small(dense(m).try_inverse().ok_or(m.ncols() - 1)?).checked(m);
        }
        if symmetric {
            let factor = Factor::sparse(SparseFactor::cholesky(pattern(m), clock), m.val(), clock);
            if let Ok(factor) = factor.and_then(|f| f.checked(m)) {
                return Ok(factor);
            }
        }
        Factor::sparse(SparseFactor::lu(pattern(m), clock), m.val(), clock)?.checked(m)
    }

    fn sparse(factor: Result<SparseFactor, NoFactor>, values: &[f64], clock: Clock) -> Result<Self, usize> {
        let factorized = factor.and_then(|mut factor| {
            factor.factorize(values, clock)?;
            Ok(Factor::Sparse(Box::new(factor)))
        });
        factorized.map_err(|_| 0)
    }

    /// Numbers stored.
    pub fn fill(&self) -> f64 {
        match self {
            Factor::Small(inverse) => inverse.len() as f64,
            Factor::Sparse(factor) => factor.size().fill,
        }
    }

    /// What solving for `columns` right-hand sides at once needs of memory.
    pub fn scratch(&self, columns: usize) -> StackReq {
        match self {
            Factor::Small(_) => StackReq::EMPTY,
            Factor::Sparse(factor) => factor.scratch(columns),
        }
    }

    /// Overwrites the right-hand sides in `x`, column after column, with the solutions.
    pub fn solve(&self, x: &mut [f64], memory: &mut MemBuffer) {
        match self {
            Factor::Small(inverse) => multiply(x, inverse.nrows(), |i, j| inverse[(i, j)]),
            Factor::Sparse(factor) => factor.solve(x, memory),
        }
    }

    /// As [`Factor::solve`], with the transposed matrix.
    pub fn solve_transposed(&self, x: &mut [f64], memory: &mut MemBuffer) {
        match self {
            Factor::Small(inverse) => multiply(x, inverse.nrows(), |i, j| inverse[(j, i)]),
            Factor::Sparse(factor) => factor.solve_transposed(x, memory),
        }
    }

    /// Itself, if it finds a known solution again. A matrix singular up to round-off may well have a factor; what such a
    /// factor gives has no correct digit.
    fn checked(self, m: &SparseColMat<usize, f64>) -> Result<Self, usize> {
        let n = m.ncols();
        // In the units of each unknown, with a share in every mode.
        let unit: Vec<f64> = (0..n).map(|j| 1.0 / scale(m, j).sqrt()).collect();
        let known: Vec<f64> = (0..n).map(|j| unit[j] * (1.0 + 0.5 * (1.7 * j as f64).sin())).collect();
        let mut x = vec![0.0; n];
        for j in 0..n {
            for (i, &value) in m.symbolic().row_idx_of_col(j).zip(m.val_of_col(j)) {
                x[i] += value * known[j];
            }
        }
        self.solve(&mut x, &mut MemBuffer::new(self.scratch(1)));
        let worst = (0..n)
            .map(|j| (j, (x[j] - known[j]).abs() / unit[j]))
            .fold((0, 0.0), |worst, e| if e.1 > worst.1 || e.1.is_nan() { e } else { worst });
        if worst.1 <= CONTROL.lost { Ok(self) } else { Err(worst.0) }
    }
}

/// The diagonal entry of a column, or its largest one where there is none: what its unknown is measured by.
fn scale(m: &SparseColMat<usize, f64>, j: usize) -> f64 {
    match m.as_ref().get(j, j) {
        Some(&d) if d != 0.0 => d.abs(),
        _ => m.val_of_col(j).iter().fold(0.0, |largest, v| v.abs().max(largest)),
    }
}

fn pattern(m: &SparseColMat<usize, f64>) -> SymbolicSparseColMat<usize> {
    let (rows, columns, starts, _, row_indices) = m.symbolic().parts();
    SymbolicSparseColMat::new_checked(rows, columns, starts.to_vec(), None, row_indices.to_vec())
}

fn dense(m: &SparseColMat<usize, f64>) -> DMatrix<f64> {
    let mut dense = DMatrix::zeros(m.nrows(), m.ncols());
    for j in 0..m.ncols() {
        for (i, &value) in m.symbolic().row_idx_of_col(j).zip(m.val_of_col(j)) {
            dense[(i, j)] = value;
        }
    }
    dense
}

/// Overwrites each column of `n` numbers in `x` with a matrix times it.
fn multiply(x: &mut [f64], n: usize, entry: impl Fn(usize, usize) -> f64) {
    for x in x.chunks_exact_mut(n) {
        let mut product = [0.0; CONTROL.small];
        for (i, p) in product[..n].iter_mut().enumerate() {
            *p = (0..n).map(|j| entry(i, j) * x[j]).sum();
        }
        x.copy_from_slice(&product[..n]);
    }
}
