use crate::stopping::Monitor;
use crate::{
    ContactProblem, FrictionSolver, SolveReport, SolveStatus, SolverKind, StoppingRule, Vector, cone,
};

/// Block Gauss–Seidel: contact after contact, the bi-potential fixed point with ρ_i = 1/λ_max(W_ii).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct GaussSeidel;

/// Fixed-point steps on one contact before the sweep goes on; neighbours change its data anyway.
const LOCAL_STEPS: usize = 20;

impl<const D: usize> FrictionSolver<D> for GaussSeidel {
    fn solve(&self, problem: &ContactProblem<D>, r: &mut [Vector<D>], rule: &StoppingRule) -> SolveReport {
        let mut monitor = Monitor::new(problem, rule);
        let status = run(&mut monitor, r);
        monitor.report(SolverKind::GaussSeidel, status, r)
    }
}

fn run<const D: usize>(monitor: &mut Monitor<'_, D>, r: &mut [Vector<D>]) -> SolveStatus {
    if let Some(status) = monitor.check(r) {
        return status;
    }
    let problem = monitor.problem();
    let steps: Vec<f64> = (0..problem.len()).map(|i| problem.step_length(i)).collect();
    let mut next_check = 1;
    loop {
        let (mut change, mut size) = (0.0, 0.0);
        for i in 0..problem.len() {
            let before = r[i];
            let local = problem.w.diagonal(i);
            let others = problem.motion(i, r) - local * before;
            for _ in 0..LOCAL_STEPS {
                let next = cone::fixed_point(&r[i], &(others + local * r[i]), problem.mu[i], steps[i]);
                let moved = (next - r[i]).norm();
                r[i] = next;
                if moved <= 0.1 * monitor.tolerance() * next.norm() {
                    break;
                }
            }
            change += (r[i] - before).norm_squared();
            size += r[i].norm_squared();
        }
        monitor.iterations += 1;
        // The residual costs a sweep: it is measured once the sweep itself hardly moves, and now and then.
        let settled = change <= (10.0 * monitor.tolerance()).powi(2) * size;
        if settled || monitor.iterations >= next_check || !change.is_finite() || monitor.exhausted().is_some()
        {
            next_check = monitor.iterations + monitor.iterations.clamp(5, 50);
            if let Some(status) = monitor.check(r) {
                return status;
            }
        }
    }
}
