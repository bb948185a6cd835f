use serde::{Deserialize, Serialize};

use crate::{ContactProblem, GaussSeidel, Measure, Uzawa, Vector};

/// When to stop.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StoppingRule {
    /// Residual (see [`Measure`]) at which a problem counts as solved.
    pub tolerance: f64,
    /// Iterations after which the solver gives up.
    pub max_iterations: usize,
}

impl Default for StoppingRule {
    fn default() -> Self {
        Self { tolerance: 1e-12, max_iterations: 10_000 }
    }
}

/// How a solve ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SolveStatus {
    /// The residual is at or below the tolerance.
    Converged,
    /// The iterations ran out.
    IterationLimit,
    /// An iterate was not a finite number.
    Diverged,
}

/// What a solver says about its answer.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SolveReport {
    /// How it ended.
    pub status: SolveStatus,
    /// Sweeps over all contacts.
    pub iterations: usize,
    /// Distance of the answer from the law, computed anew from it.
    pub measure: Measure,
}

impl SolveReport {
    /// Whether the answer is a solution.
    #[must_use]
    pub fn is_converged(&self) -> bool {
        self.status == SolveStatus::Converged
    }

    /// The report of an answer that was measured after `iterations`.
    pub(crate) fn of(measure: Measure, iterations: usize, rule: &StoppingRule) -> Self {
        let status = if measure.residual <= rule.tolerance {
            SolveStatus::Converged
        } else if measure.residual.is_finite() {
            SolveStatus::IterationLimit
        } else {
            SolveStatus::Diverged
        };
        Self { status, iterations, measure }
    }
}

/// A method for contact problems. It does not fail: a solver that stops early says so in its report.
pub trait FrictionSolver<const D: usize>: Send + Sync {
    /// Improves `r` [N], one reaction per contact, from the guess it holds.
    fn solve(&self, problem: &ContactProblem<D>, r: &mut [Vector<D>], rule: &StoppingRule) -> SolveReport;
}

/// The solvers by name.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum SolverKind {
    /// Block Gauss–Seidel with the bi-potential fixed point on each contact.
    #[default]
    GaussSeidel,
    /// The simultaneous bi-potential Uzawa iteration of the paper.
    Uzawa,
}

impl SolverKind {
    /// Every solver.
    pub const ALL: [SolverKind; 2] = [SolverKind::GaussSeidel, SolverKind::Uzawa];

    /// The solver of this kind.
    #[must_use]
    pub fn solver<const D: usize>(self) -> Box<dyn FrictionSolver<D>> {
        match self {
            SolverKind::GaussSeidel => Box::new(GaussSeidel),
            SolverKind::Uzawa => Box::new(Uzawa),
        }
    }
}
