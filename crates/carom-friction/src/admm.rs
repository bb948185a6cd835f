use crate::clock::Clock;
use crate::penalised::Penalised;
use crate::sparse_factor::NoFactor;
use crate::splitting::{self, LinearLaw};
use crate::stopping::Monitor;
use crate::{
    ContactProblem, FrictionSolver, SolveReport, SolveStatus, SolverKind, StoppingRule, Vector, scaled,
};

/// The alternating direction method of multipliers: the solution of a linear system with one factor, and projections on the
/// friction cones, in turn. W need not be symmetric.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Admm;

impl<const D: usize> FrictionSolver<D> for Admm {
    fn solve(&self, problem: &ContactProblem<D>, r: &mut [Vector<D>], rule: &StoppingRule) -> SolveReport {
        scaled::solve(problem, r, rule, |monitor, r| {
            (SolverKind::Admm, run(monitor, r, usize::MAX).unwrap_or(SolveStatus::Stalled))
        })
    }
}

/// Iterates until it is time to stop, or `max_iterations` times: then None.
pub(crate) fn run<const D: usize>(
    monitor: &mut Monitor<'_, D>,
    r: &mut [Vector<D>],
    max_iterations: usize,
) -> Option<SolveStatus> {
    let problem = monitor.problem();
    let mut law = match Reactions::new(problem, monitor.stiffness(), monitor.clock()) {
        Ok(law) => law,
        Err(NoFactor::Singular) => return None,
        Err(NoFactor::TimeIsUp) => return Some(SolveStatus::TimeLimit),
    };
    splitting::run(monitor, &mut law, &problem.mu, r, max_iterations)
}

/// The pairs u = W a + q by a factor of W: with a + ρ u = sum, (W + ρ⁻¹) a = ρ⁻¹ sum − q.
struct Reactions<'a, const D: usize> {
    problem: &'a ContactProblem<D>,
    stiffness: Vec<f64>,
    factor: Penalised<'a, D>,
    inverse_rho: Vec<f64>,
    a: Vec<Vector<D>>,
}

impl<'a, const D: usize> Reactions<'a, D> {
    /// With the `stiffness` [N/m] of contacts that nothing can move.
    fn new(problem: &'a ContactProblem<D>, stiffness: f64, clock: Clock) -> Result<Self, NoFactor> {
        let n = problem.len();
        let own = |i| {
            let trace = problem.w.diagonal(i).trace();
            if trace > 0.0 { D as f64 / trace } else { stiffness }
        };
        Ok(Self {
            problem,
            stiffness: (0..n).map(own).collect(),
            factor: Penalised::new(&problem.w, clock)?,
            inverse_rho: vec![0.0; n],
            a: vec![Vector::zeros(); n],
        })
    }
}

impl<const D: usize> LinearLaw<D> for Reactions<'_, D> {
    /// Between rigid bodies a contact moves with many others: penalties mostly end between 5 and 50.
    fn first_scale(&self) -> f64 {
        20.0
    }

    fn stiffness(&self) -> &[f64] {
        &self.stiffness
    }

    fn prepare(&mut self, scale: f64) -> Result<(), NoFactor> {
        for i in 0..self.stiffness.len() {
            self.inverse_rho[i] = 1.0 / (scale * self.stiffness[i]);
        }
        self.factor.factorize(&self.inverse_rho)
    }

    fn motion(&mut self, sum: &[Vector<D>], motion: &mut [Vector<D>]) {
        for i in 0..sum.len() {
            self.a[i] = sum[i] * self.inverse_rho[i] - self.problem.q[i];
        }
        self.factor.solve(&mut self.a);
        for i in 0..sum.len() {
            motion[i] = (sum[i] - self.a[i]) * self.inverse_rho[i];
        }
    }
}
