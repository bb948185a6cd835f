use crate::equation::Equation;
use crate::newton::Newton;
use crate::stopping::Monitor;
use crate::{
    ContactProblem, FrictionSolver, SolveReport, SolveStatus, SolverKind, StoppingRule, Vector, cone,
};

/// The proximal point method: W + shift I instead of W, around the last answer, solved by Newton's iterations; the shift
/// shrinks as they converge and grows where they do not.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Proximal;

impl<const D: usize> FrictionSolver<D> for Proximal {
    fn solve(&self, problem: &ContactProblem<D>, r: &mut [Vector<D>], rule: &StoppingRule) -> SolveReport {
        let mut monitor = Monitor::new(problem, rule);
        let status = run(&mut monitor, r, usize::MAX).unwrap_or(SolveStatus::Stalled);
        monitor.report(SolverKind::Proximal, status, r)
    }
}

pub(crate) fn run<const D: usize>(
    monitor: &mut Monitor<'_, D>,
    r: &mut [Vector<D>],
    max_blocks: usize,
) -> Option<SolveStatus> {
    if let Some(status) = monitor.check(r) {
        return Some(status);
    }
    let problem = monitor.problem();
    let mut newton = Newton::new(problem, Equation::AlartCurnier, max_blocks)?;
    let rho: Vec<f64> = (0..problem.len()).map(|i| problem.step_length(i)).collect();
    let mut centre = r.to_vec();
    let mut trial = r.to_vec();
    let mut shift = 0.1 / monitor.stiffness();
    let size_q = monitor.stiffness() * problem.q.iter().map(Vector::norm_squared).sum::<f64>().sqrt();
    let verbose = std::env::var("VERBOSE").is_ok();
    loop {
        let size = size_q.max(r.iter().map(Vector::norm_squared).sum::<f64>().sqrt());
        let wanted = 0.01 * monitor.tolerance() * size;
        trial.copy_from_slice(r);
        let end = newton.solve(problem, &rho, shift, &centre, &mut trial, wanted, 30);
        monitor.iterations += end.iterations;
        let relative = end.merit / size;
        if relative < 1e-3 {
            for ((r, c), t) in r.iter_mut().zip(&mut centre).zip(&trial) {
                *r = cone::project(t, 0.0f64.max(1.0) * 0.0 + 1e9);
                *r = *t;
                *c = *t;
            }
            for i in 0..r.len() {
                r[i] = cone::project(&r[i], problem.mu[i]);
                centre[i] = r[i];
            }
            let s = monitor.check(r);
            if verbose {
                eprintln!(
                    "shift {:.1e} its {} inner {:.1e} res {:.2e}",
                    shift * monitor.stiffness(),
                    end.iterations,
                    relative,
                    monitor.residual()
                );
            }
            if s.is_some() {
                return s;
            }
            shift *= 0.2;
        } else {
            if verbose {
                eprintln!(
                    "shift {:.1e} its {} inner {:.1e} FAILED",
                    shift * monitor.stiffness(),
                    end.iterations,
                    relative
                );
            }
            shift *= 5.0;
        }
        if let Some(s) = monitor.exhausted() {
            return Some(s);
        }
    }
}
