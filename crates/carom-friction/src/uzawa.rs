use crate::stopping::Monitor;
use crate::{
    ContactProblem, FrictionSolver, SolveReport, SolveStatus, SolverKind, StoppingRule, Vector, cone,
};

/// The paper's solver: the bi-potential fixed point swept over all contacts at once, with one ρ = 1/λ_max(W).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Uzawa;

/// Power iterations for λ_max(W); the answer only sets a step length.
const POWER_ITERATIONS: usize = 30;

impl<const D: usize> FrictionSolver<D> for Uzawa {
    fn solve(&self, problem: &ContactProblem<D>, r: &mut [Vector<D>], rule: &StoppingRule) -> SolveReport {
        let mut monitor = Monitor::new(problem, rule);
        let status = run(&mut monitor, r);
        monitor.report(SolverKind::Uzawa, status, r)
    }
}

fn run<const D: usize>(monitor: &mut Monitor<'_, D>, r: &mut [Vector<D>]) -> SolveStatus {
    if let Some(status) = monitor.check(r) {
        return status;
    }
    let problem = monitor.problem();
    let mut motions = vec![Vector::zeros(); problem.len()];
    let rho = step_length(problem, &mut motions);
    loop {
        let (mut change, mut size) = (0.0, 0.0);
        for (i, motion) in motions.iter_mut().enumerate() {
            *motion = problem.motion(i, r);
        }
        for (i, motion) in motions.iter().enumerate() {
            let next = cone::fixed_point(&r[i], motion, problem.mu[i], rho);
            change += (next - r[i]).norm_squared();
            size += next.norm_squared();
            r[i] = next;
        }
        monitor.iterations += 1;
        let settled = change <= monitor.tolerance().powi(2) * size;
        if settled
            || monitor.iterations.is_multiple_of(50)
            || !change.is_finite()
            || monitor.exhausted().is_some()
        {
            if let Some(status) = monitor.check(r) {
                return status;
            }
        }
    }
}

/// 1/λ_max(W) by power iteration on W, from a start that no symmetry makes orthogonal to the largest mode.
fn step_length<const D: usize>(problem: &ContactProblem<D>, scratch: &mut [Vector<D>]) -> f64 {
    let n = problem.len();
    let mut x: Vec<Vector<D>> =
        (0..n).map(|i| Vector::from_fn(|k, _| 1.0 + 0.5 * ((i * D + k) as f64 * 1.7).sin())).collect();
    let mut largest = 0.0;
    for _ in 0..POWER_ITERATIONS {
        let norm = x.iter().map(Vector::norm_squared).sum::<f64>().sqrt();
        if norm == 0.0 {
            return 0.0;
        }
        x.iter_mut().for_each(|x| *x /= norm);
        for (i, s) in scratch.iter_mut().enumerate() {
            *s = problem.w.row_times(i, &x);
        }
        largest = scratch.iter().map(Vector::norm_squared).sum::<f64>().sqrt();
        x.copy_from_slice(scratch);
    }
    if largest > 0.0 { 1.0 / largest } else { 0.0 }
}
