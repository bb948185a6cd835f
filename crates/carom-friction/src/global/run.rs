use std::time::Instant;

use super::GlobalMethod;
use super::admm::Velocities;
use super::choice::cost_of_admm;
use super::compliance::Compliance;
use crate::{Sample, SolveReport, SolverKind, StoppingRule, Vector};

/// A global problem whose M is factorised, on its way to an answer.
pub(super) struct Run<'a, const D: usize> {
    pub compliance: &'a Compliance<'a, D>,
    pub rule: &'a StoppingRule,
    /// When the time began to count.
    pub start: Instant,
}

impl<const D: usize> Run<'_, D> {
    /// By the method asked for; also says which it was.
    pub fn solve(
        &self,
        r: &mut [Vector<D>],
        method: GlobalMethod,
        solver: SolverKind,
    ) -> (GlobalMethod, SolveReport) {
        let Some(law) = self.law(method, solver) else {
            return (GlobalMethod::Condense, self.condensed(r, solver, self.rule.max_iterations));
        };
        let is_last = method == GlobalMethod::Admm || self.compliance.is_too_large_to_condense();
        let limit = if is_last { usize::MAX } else { self.compliance.patience(law.size()) };
        let report = law.solve(r, &self.remaining(self.rule.max_iterations.min(limit)));
        let iterations = self.rule.max_iterations.saturating_sub(report.iterations);
        let is_out_of_time = self.rule.time_limit.is_some_and(|limit| self.start.elapsed() >= limit);
        if is_last || report.is_solved() || iterations == 0 || is_out_of_time {
            return (GlobalMethod::Admm, report);
        }
        (GlobalMethod::Condense, after(&report, self.condensed(r, solver, iterations)))
    }

    /// What ADMM without W needs, where that is asked for, or left open and cheaper.
    fn law(&self, method: GlobalMethod, solver: SolverKind) -> Option<Velocities<'_, D>> {
        let is_open = solver == SolverKind::default() || solver == SolverKind::Admm;
        let law = || Velocities::new(self.compliance).ok();
        match method {
            GlobalMethod::Condense => None,
            GlobalMethod::Admm => law(),
            GlobalMethod::Auto if is_open => {
                let condensing = self.compliance.cost_of_condensing();
                // The structure of the factor is only found where it can matter.
                let hopeful = condensing > self.compliance.least_cost_of_admm();
                hopeful.then(law).flatten().filter(|law| condensing > cost_of_admm(law.size()))
            }
            GlobalMethod::Auto => None,
        }
    }

    fn condensed(&self, r: &mut [Vector<D>], solver: SolverKind, max_iterations: usize) -> SolveReport {
        let local = self.compliance.condense();
        solver.solver().solve(&local, r, &self.remaining(max_iterations))
    }

    fn remaining(&self, max_iterations: usize) -> StoppingRule {
        let time_limit = self.rule.time_limit.map(|limit| limit.saturating_sub(self.start.elapsed()));
        StoppingRule { max_iterations, time_limit, ..*self.rule }
    }
}

/// The report `later`, with the iterations of `earlier` before its own.
fn after(earlier: &SolveReport, mut later: SolveReport) -> SolveReport {
    let shifted = later.history.iter().map(|s| Sample { iteration: s.iteration + earlier.iterations, ..*s });
    later.history = earlier.history.iter().copied().chain(shifted).collect();
    later.iterations += earlier.iterations;
    later
}
