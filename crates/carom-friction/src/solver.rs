use crate::{ContactProblem, SolveReport, StoppingRule, Vector};

/// A method for contact problems. It does not fail: a solver that stops early says so in its report.
pub trait FrictionSolver<const D: usize>: Send + Sync {
    /// Improves `r` [N], one reaction per contact, from the guess it holds.
    fn solve(&self, problem: &ContactProblem<D>, r: &mut [Vector<D>], rule: &StoppingRule) -> SolveReport;
}
