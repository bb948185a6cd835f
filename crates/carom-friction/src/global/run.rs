use super::admm::Velocities;
use super::choice::cost_of_admm;
use super::compliance::Compliance;
use super::measurable::Measurable;
use super::method::GlobalMethod;
use crate::clock::{Clock, TimeIsUp};
use crate::sparse_factor::NoFactor;
use crate::stopping::Monitor;
use crate::{Sample, SolveReport, SolveStatus, SolverKind, StoppingRule, Vector};

/// A global problem whose M is factorised, on its way to an answer.
pub(super) struct Run<'a, const D: usize> {
    pub compliance: &'a Compliance<'a, D>,
    pub rule: &'a StoppingRule,
    pub clock: Clock,
}

impl<const D: usize> Run<'_, D> {
    /// By the method asked for; also says which it was.
    pub fn solve(
        &self,
        r: &mut [Vector<D>],
        method: GlobalMethod,
        solver: SolverKind,
    ) -> (GlobalMethod, SolveReport) {
        let law = match self.law(method, solver) {
            Ok(Some(law)) => law,
            Ok(None) => {
                return (GlobalMethod::Condense, self.condensed(r, solver, self.rule.max_iterations));
            }
            Err(TimeIsUp) => return (GlobalMethod::Admm, self.out_of_time(r, SolverKind::Admm)),
        };
        let is_last = method == GlobalMethod::Admm || self.compliance.is_too_large_to_condense();
        let limit = if is_last { usize::MAX } else { self.compliance.patience(law.size()) };
        let report = law.solve(r, &self.remaining(self.rule.max_iterations.min(limit)));
        let iterations = self.rule.max_iterations.saturating_sub(report.iterations);
        if is_last || report.is_solved() || iterations == 0 || self.clock.is_over() {
            return (GlobalMethod::Admm, report);
        }
        (GlobalMethod::Condense, after(&report, self.condensed(r, solver, iterations)))
    }

    /// What ADMM without W needs, where that is asked for, or left open and cheaper.
    fn law(&self, method: GlobalMethod, solver: SolverKind) -> Result<Option<Velocities<'_, D>>, TimeIsUp> {
        let is_open = solver == SolverKind::default() || solver == SolverKind::Admm;
        let law = || match Velocities::new(self.compliance, self.clock) {
            Err(NoFactor::TimeIsUp) => Err(TimeIsUp),
            law => Ok(law.ok()),
        };
        match method {
            GlobalMethod::Condense => Ok(None),
            GlobalMethod::Admm => law(),
            GlobalMethod::Auto if is_open => {
                let condensing = self.compliance.cost_of_condensing();
                // The structure of the factor is only found where it can matter.
                let hopeful = condensing > self.compliance.least_cost_of_admm();
                let law = if hopeful { law()? } else { None };
                Ok(law.filter(|law| condensing > cost_of_admm(law.size())))
            }
            GlobalMethod::Auto => Ok(None),
        }
    }

    fn condensed(&self, r: &mut [Vector<D>], solver: SolverKind, max_iterations: usize) -> SolveReport {
        match self.compliance.condense(self.clock) {
            Ok(local) => solver.solver().solve(&local, r, &self.remaining(max_iterations)),
            Err(TimeIsUp) => self.out_of_time(r, solver),
        }
    }

    /// The report on the guess, where the time was up before the first iteration.
    fn out_of_time(&self, r: &[Vector<D>], solver: SolverKind) -> SolveReport {
        let problem = Measurable::new(self.compliance);
        Monitor::new(&problem, self.rule, self.clock).report(solver, SolveStatus::TimeLimit, r)
    }

    /// The report on `r`, which is what the caller gets of the reactions that `report` is about.
    pub fn judged_again(&self, report: SolveReport, r: &[Vector<D>]) -> SolveReport {
        let problem = Measurable::new(self.compliance);
        let again = Monitor::new(&problem, self.rule, self.clock).report(report.solver, report.status, r);
        SolveReport { status: again.status, measure: again.measure, ..report }
    }

    fn remaining(&self, max_iterations: usize) -> StoppingRule {
        StoppingRule { max_iterations, time_limit: self.clock.left(), ..*self.rule }
    }
}

/// The report `later`, with the iterations of `earlier` before its own.
fn after(earlier: &SolveReport, mut later: SolveReport) -> SolveReport {
    let shifted = later.history.iter().map(|s| Sample { iteration: s.iteration + earlier.iterations, ..*s });
    later.history = earlier.history.iter().copied().chain(shifted).collect();
    later.iterations += earlier.iterations;
    later
}
