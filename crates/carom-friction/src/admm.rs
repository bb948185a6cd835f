use faer::dyn_stack::MemBuffer;
use faer::sparse::SymbolicSparseColMat;

use crate::sparse_factor::{NoFactor, SparseFactor};
use crate::splitting::{self, LinearLaw};
use crate::stopping::Monitor;
use crate::{
    BlockMatrix, ContactProblem, FrictionSolver, SolveReport, SolveStatus, SolverKind, StoppingRule, Vector,
};

/// ADMM, the alternating direction method of multipliers: a sparse factor of W + I/ρ and projections on the cone in turn.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Admm;

impl<const D: usize> FrictionSolver<D> for Admm {
    fn solve(&self, problem: &ContactProblem<D>, r: &mut [Vector<D>], rule: &StoppingRule) -> SolveReport {
        let mut monitor = Monitor::new(problem, rule);
        let status = run(&mut monitor, r).unwrap_or(SolveStatus::Stalled);
        monitor.report(SolverKind::Admm, status, r)
    }
}

/// # Errors
/// If W + I/ρ has no factor for some ρ.
pub(crate) fn run<const D: usize>(
    monitor: &mut Monitor<'_, D>,
    r: &mut [Vector<D>],
) -> Result<SolveStatus, NoFactor> {
    let problem = monitor.problem();
    if problem.is_empty() {
        return Ok(SolveStatus::Solved);
    }
    splitting::run(monitor, &mut Reactions::new(problem)?, &problem.mu, r)
}

/// The pairs u = W a + q by a factor of W: with a + ρ u = sum, (W + I/ρ) a = sum/ρ − q.
struct Reactions<'a, const D: usize> {
    problem: &'a ContactProblem<D>,
    /// Of the transpose: rows of W are stored as columns.
    factor: SparseFactor,
    values: Vec<f64>,
    /// Where the diagonal is among the values.
    diagonal: Vec<usize>,
    shifted: Vec<f64>,
    rho: f64,
    a: Vec<f64>,
    memory: MemBuffer,
}

impl<'a, const D: usize> Reactions<'a, D> {
    fn new(problem: &'a ContactProblem<D>) -> Result<Self, NoFactor> {
        let n = problem.len() * D;
        let (mut starts, mut columns, mut values, mut diagonal) =
            (vec![0], Vec::new(), Vec::new(), Vec::new());
        for i in 0..problem.len() {
            for a in 0..D {
                for (j, block) in problem.w.row(i) {
                    for b in 0..D {
                        if (i, a) == (j, b) {
                            diagonal.push(values.len());
                        }
                        columns.push(j * D + b);
                        values.push(block[(a, b)]);
                    }
                }
                starts.push(values.len());
            }
        }
        let pattern = SymbolicSparseColMat::new_checked(n, n, starts, None, columns);
        let factor = if is_symmetric(&problem.w) {
            SparseFactor::cholesky(pattern)
        } else {
            SparseFactor::lu(pattern)
        }?;
        Ok(Self {
            problem,
            memory: MemBuffer::new(factor.scratch(1)),
            factor,
            shifted: values.clone(),
            values,
            diagonal,
            rho: 0.0,
            a: vec![0.0; n],
        })
    }
}

impl<const D: usize> LinearLaw<D> for Reactions<'_, D> {
    fn prepare(&mut self, rho: f64) -> Result<(), NoFactor> {
        self.rho = rho;
        for &k in &self.diagonal {
            self.shifted[k] = self.values[k] + 1.0 / rho;
        }
        self.factor.factorize(&self.shifted)
    }

    fn motion(&mut self, sum: &[Vector<D>], motion: &mut [Vector<D>]) {
        let per_rho = 1.0 / self.rho;
        for (a, (sum, q)) in self.a.chunks_exact_mut(D).zip(sum.iter().zip(&self.problem.q)) {
            a.copy_from_slice((sum * per_rho - q).as_slice());
        }
        self.factor.solve_transposed(&mut self.a, &mut self.memory);
        for (u, (sum, a)) in motion.iter_mut().zip(sum.iter().zip(self.a.chunks_exact(D))) {
            *u = (sum - Vector::from_column_slice(a)) * per_rho;
        }
    }
}

/// Whether opposite blocks are each other's transposes up to round-off.
fn is_symmetric<const D: usize>(w: &BlockMatrix<D>) -> bool {
    let size = (0..w.row_count()).map(|i| w.diagonal(i).amax()).fold(0.0, f64::max);
    let mut next = vec![0; w.row_count()];
    (0..w.row_count()).all(|i| {
        w.row(i).all(|(j, block)| {
            // Rows are taken in ascending order, so that row j is read from left to right.
            let opposite = w.row(j).nth(next[j]);
            next[j] += 1;
            opposite
                .is_some_and(|(k, other)| k == i && (block - other.transpose()).amax() <= ROUND_OFF * size)
        })
    })
}

/// Asymmetry, relative to the largest entry, that is round-off.
const ROUND_OFF: f64 = 1e-13;
