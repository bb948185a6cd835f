use crate::{ContactProblem, FrictionSolver, SolveReport, StoppingRule, Vector, cone, measure};

/// Block Gauss–Seidel: contact after contact, the bi-potential fixed point with ρ_i = 1/λ_max(W_ii).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct GaussSeidel;

/// Fixed-point steps on one contact before the sweep goes on; neighbours change its data anyway.
const LOCAL_STEPS: usize = 20;

impl<const D: usize> FrictionSolver<D> for GaussSeidel {
    fn solve(&self, problem: &ContactProblem<D>, r: &mut [Vector<D>], rule: &StoppingRule) -> SolveReport {
        let mut best = measure(problem, r);
        for iteration in 0..rule.max_iterations {
            if best.residual <= rule.tolerance || !best.residual.is_finite() {
                return SolveReport::of(best, iteration, rule);
            }
            let (mut change, mut size) = (0.0, 0.0);
            for i in 0..problem.len() {
                let before = r[i];
                let rho = problem.step_length(i);
                let local = problem.w.diagonal(i);
                let others = problem.motion(i, r) - local * before;
                for _ in 0..LOCAL_STEPS {
                    let next = cone::fixed_point(&r[i], &(others + local * r[i]), problem.mu[i], rho);
                    let moved = (next - r[i]).norm();
                    r[i] = next;
                    if moved <= 0.1 * rule.tolerance * next.norm() {
                        break;
                    }
                }
                change += (r[i] - before).norm_squared();
                size += r[i].norm_squared();
            }
            // The full residual costs a sweep: it is measured once the sweep itself hardly moves, and now and then.
            let settled = change <= (10.0 * rule.tolerance).powi(2) * size;
            if settled || iteration % 50 == 49 || iteration + 1 == rule.max_iterations || !change.is_finite()
            {
                best = measure(problem, r);
            }
        }
        SolveReport::of(best, rule.max_iterations, rule)
    }
}
