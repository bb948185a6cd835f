//! Any problem in numbers that a solver can count with.

use crate::stopping::Monitor;
use crate::units::Units;
use crate::{ContactProblem, SolveReport, SolveStatus, SolverKind, StoppingRule, Vector};

/// Solves `problem` by `run` in units in which that is safe. What is reported is measured of the reactions as they are handed back.
pub(crate) fn solve<const D: usize>(
    problem: &ContactProblem<D>,
    r: &mut [Vector<D>],
    rule: &StoppingRule,
    run: impl FnOnce(&mut Monitor<'_, D>, &mut [Vector<D>]) -> (SolverKind, SolveStatus),
) -> SolveReport {
    let clock = rule.clock();
    let units = Units::of(problem);
    if units.are_own() {
        let mut monitor = Monitor::new(problem, rule, clock);
        drop_useless_reactions(&mut monitor, r);
        let (kind, status) = run(&mut monitor, r);
        drop_what_is_no_number(r);
        return monitor.report(kind, status, r);
    }
    let scaled = units.enter(problem);
    units.enter_reactions(r);
    let rule = StoppingRule { unit: units.stiffness(rule.unit), ..*rule };
    let mut monitor = Monitor::new(&scaled, &rule, clock);
    drop_useless_reactions(&mut monitor, r);
    let (kind, status) = run(&mut monitor, r);
    drop_what_is_no_number(r);
    // There and back again: the answer is judged as the caller gets it.
    units.leave_reactions(r);
    let mut returned = r.to_vec();
    units.enter_reactions(&mut returned);
    let mut report = monitor.report(kind, status, &returned);
    report.measure.certificate = units.leave_energy(report.measure.certificate);
    report
}

/// Iterations may end in nothing, of contacts that yield against their reactions say. Nobody is handed that.
fn drop_what_is_no_number<const D: usize>(r: &mut [Vector<D>]) {
    if !r.iter().all(|r| r.iter().all(|x| x.is_finite())) {
        r.fill(Vector::zeros());
    }
}

/// Where no motions call for reactions none are an answer, and the residual of any others has nothing to be small beside. Those that have no
/// square are no start.
fn drop_useless_reactions<const D: usize>(monitor: &mut Monitor<'_, D>, r: &mut [Vector<D>]) {
    let is_idle = monitor.problem().q.iter().all(|q| q.iter().all(|x| *x == 0.0));
    let square: f64 = r.iter().map(Vector::norm_squared).sum();
    if !square.is_finite() || is_idle && !monitor.is_solved_by(r) {
        r.fill(Vector::zeros());
    }
}
