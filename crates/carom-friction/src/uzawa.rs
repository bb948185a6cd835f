use crate::{ContactProblem, FrictionSolver, SolveReport, StoppingRule, Vector, cone, measure};

/// The paper's solver: the bi-potential fixed point swept over all contacts at once, with one ρ = 1/λ_max(W).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Uzawa;

/// Power iterations for λ_max(W); the answer only sets a step length.
const POWER_ITERATIONS: usize = 30;

impl<const D: usize> FrictionSolver<D> for Uzawa {
    fn solve(&self, problem: &ContactProblem<D>, r: &mut [Vector<D>], rule: &StoppingRule) -> SolveReport {
        let n = problem.len();
        let mut motions = vec![Vector::zeros(); n];
        let rho = step_length(problem, &mut motions);
        for iteration in 0..rule.max_iterations {
            let mut change = 0.0;
            let mut size = 0.0;
            for (i, motion) in motions.iter_mut().enumerate() {
                *motion = problem.motion(i, r);
            }
            for (i, motion) in motions.iter().enumerate() {
                let next = cone::fixed_point(&r[i], motion, problem.mu[i], rho);
                change += (next - r[i]).norm_squared();
                size += next.norm_squared();
                r[i] = next;
            }
            let settled = change <= rule.tolerance.powi(2) * size;
            if settled || iteration % 50 == 49 || !change.is_finite() {
                let measure = measure(problem, r);
                if measure.residual <= rule.tolerance || !measure.residual.is_finite() {
                    return SolveReport::of(measure, iteration + 1, rule);
                }
            }
        }
        SolveReport::of(measure(problem, r), rule.max_iterations, rule)
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
