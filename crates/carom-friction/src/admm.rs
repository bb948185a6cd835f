use crate::block_lu::BlockLu;
use crate::sparse_factor::NoFactor;
use crate::splitting::{self, LinearLaw};
use crate::stopping::Monitor;
use crate::{
    ContactProblem, FrictionSolver, Matrix, SolveReport, SolveStatus, SolverKind, StoppingRule, Vector,
};

/// The alternating direction method of multipliers: the solution of a linear system with one factor, and projections on the
/// friction cones, in turn. W need not be symmetric.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Admm;

impl<const D: usize> FrictionSolver<D> for Admm {
    fn solve(&self, problem: &ContactProblem<D>, r: &mut [Vector<D>], rule: &StoppingRule) -> SolveReport {
        let mut monitor = Monitor::new(problem, rule);
        let status = run(&mut monitor, r, usize::MAX);
        monitor.report(SolverKind::Admm, status.unwrap_or(SolveStatus::Stalled), r)
    }
}

/// Iterates until it is time to stop, or `max_iterations` times: then None.
pub(crate) fn run<const D: usize>(
    monitor: &mut Monitor<'_, D>,
    r: &mut [Vector<D>],
    max_iterations: usize,
) -> Option<SolveStatus> {
    let problem = monitor.problem();
    let mut law = Reactions::new(problem, monitor.stiffness())?;
    splitting::run(monitor, &mut law, &problem.mu, r, max_iterations)
}

/// The pairs u = W a + q by a factor of W: with a + ρ u = sum, (W + ρ⁻¹) a = ρ⁻¹ sum − q.
struct Reactions<'a, const D: usize> {
    problem: &'a ContactProblem<D>,
    stiffness: Vec<f64>,
    lu: BlockLu<D>,
    ones: Vec<Matrix<D>>,
    inverse_rho: Vec<f64>,
    penalties: Vec<Matrix<D>>,
    a: Vec<Vector<D>>,
}

impl<'a, const D: usize> Reactions<'a, D> {
    /// With the `stiffness` [N/m] of contacts that nothing can move.
    fn new(problem: &'a ContactProblem<D>, stiffness: f64) -> Option<Self> {
        let n = problem.len();
        let own = |i| {
            let trace = problem.w.diagonal(i).trace();
            if trace > 0.0 { D as f64 / trace } else { stiffness }
        };
        Some(Self {
            problem,
            stiffness: (0..n).map(own).collect(),
            lu: BlockLu::new(&problem.w, usize::MAX)?,
            ones: vec![Matrix::identity(); n],
            inverse_rho: vec![0.0; n],
            penalties: vec![Matrix::zeros(); n],
            a: vec![Vector::zeros(); n],
        })
    }
}

impl<const D: usize> LinearLaw<D> for Reactions<'_, D> {
    /// Between rigid bodies a contact moves with many others: penalties mostly end between 5 and 50.
    const FIRST_SCALE: f64 = 20.0;

    fn stiffness(&self) -> &[f64] {
        &self.stiffness
    }

    fn prepare(&mut self, scale: f64) -> Result<(), NoFactor> {
        for i in 0..self.stiffness.len() {
            self.inverse_rho[i] = 1.0 / (scale * self.stiffness[i]);
            self.penalties[i] = Matrix::identity() * self.inverse_rho[i];
        }
        self.lu.factorize(&self.problem.w, 0.0, &self.ones, &self.penalties).map_err(|_| NoFactor)
    }

    fn motion(&mut self, sum: &[Vector<D>], motion: &mut [Vector<D>]) {
        for i in 0..sum.len() {
            self.a[i] = sum[i] * self.inverse_rho[i] - self.problem.q[i];
        }
        self.lu.solve(&mut self.a);
        for i in 0..sum.len() {
            motion[i] = (sum[i] - self.a[i]) * self.inverse_rho[i];
        }
    }
}
