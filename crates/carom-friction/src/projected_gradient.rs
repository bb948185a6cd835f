use crate::schedule::Schedule;
use crate::stopping::Monitor;
use crate::{
    ContactProblem, FrictionSolver, SolveReport, SolveStatus, SolverKind, StoppingRule, Vector, cone, scaled,
};

/// Accelerated projected gradients on the convex problem min ½ r·W r + r·(q + s n) over K, whose slip s = μ|w_t| follows the
/// iteration.
///
/// Momentum after Nesterov with restarts [B. O'Donoghue, E. Candès, Found. Comput. Math. 15 (2015) 715–732], steps by
/// backtracking [H. Mazhar, T. Heyn, D. Negrut, A. Tasora, ACM Trans. Graph. 34 (2015) 32], scaled by contact with
/// ρ_i = 1/λ_max(W_ii). One product with W per iteration, and memory for a few vectors.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct ProjectedGradient;

/// How long steps are, and how fast the slip follows.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Control {
    /// Share of its change by which s follows the motions at first; a faster one takes fewer iterations, but may never come to rest.
    slip_rate: f64,
    /// The least of it.
    least_slip_rate: f64,
    /// Iterations without progress after which s follows half as fast.
    patience: usize,
    /// Least Lipschitz constant: that of the scaled W is 1 or more, but where reactions are free to grow none is seen.
    least_lipschitz: f64,
    /// Growth of the step length per iteration.
    longer: f64,
    /// Its least reduction where it was too long.
    shorter: f64,
}

/// The thresholds of every run.
const CONTROL: Control = Control {
    slip_rate: 0.5,
    least_slip_rate: 0.01,
    patience: 1000,
    least_lipschitz: 1e-3,
    longer: 1.02,
    shorter: 1.5,
};

impl<const D: usize> FrictionSolver<D> for ProjectedGradient {
    fn solve(&self, problem: &ContactProblem<D>, r: &mut [Vector<D>], rule: &StoppingRule) -> SolveReport {
        scaled::solve(problem, r, rule, |monitor, r| {
            (SolverKind::ProjectedGradient, run(monitor, r, usize::MAX).unwrap_or(SolveStatus::Stalled))
        })
    }
}

/// Iterates until it is time to stop, or `max_iterations` times: then None.
pub(crate) fn run<const D: usize>(
    monitor: &mut Monitor<'_, D>,
    r: &mut [Vector<D>],
    max_iterations: usize,
) -> Option<SolveStatus> {
    let problem = monitor.problem();
    let n = problem.len();
    let rho = problem.step_lengths();
    problem.bring_into_cones(rho.iter().copied(), r);
    if let Some(status) = monitor.check(r) {
        return Some(status);
    }
    let slip = |i: usize, w: &Vector<D>| problem.mu[i] * cone::tangential_norm(w);
    let mut motion: Vec<Vector<D>> = (0..n).map(|i| problem.motion(i, r)).collect();
    let mut s: Vec<f64> = (0..n).map(|i| slip(i, &motion[i])).collect();
    // The point ahead, with its motions, and the one after it.
    let (mut ahead, mut motion_ahead) = (r.to_vec(), motion.clone());
    let (mut next, mut next_motion) = (r.to_vec(), motion.clone());
    // Lipschitz constant of the scaled gradient, and Nesterov's sequence.
    let (mut lipschitz, mut t) = (1.0, 1.0_f64);
    let (mut smallest, mut stale, mut slip_rate) = (f64::INFINITY, 0, CONTROL.slip_rate);
    let mut schedule = Schedule::new(monitor.tolerance(), monitor.iterations);
    let last = monitor.iterations.saturating_add(max_iterations);
    while monitor.iterations < last {
        let (mut squared_length, mut curvature, mut turn) = (0.0, 0.0, 0.0);
        for i in 0..n {
            let mut gradient = motion_ahead[i];
            gradient[0] += s[i];
            next[i] = cone::project(&(ahead[i] - gradient * (rho[i] / lipschitz)), problem.mu[i]);
        }
        for i in 0..n {
            next_motion[i] = problem.motion(i, &next);
            if rho[i] > 0.0 {
                let step = next[i] - ahead[i];
                squared_length += step.norm_squared() / rho[i];
                curvature += step.dot(&(next_motion[i] - motion_ahead[i]));
                turn -= step.dot(&(next[i] - r[i])) / rho[i];
            }
        }
        monitor.iterations += 1;
        if curvature > lipschitz * squared_length && monitor.exhausted().is_none() {
            lipschitz = (curvature / squared_length).max(CONTROL.shorter * lipschitz);
            continue;
        }
        // Momentum that points back is dropped.
        let turns_back = turn > 0.0;
        let longer = 0.5 * (1.0 + (1.0 + 4.0 * t * t).sqrt());
        let momentum = if turns_back { 0.0 } else { (t - 1.0) / longer };
        t = if turns_back { 1.0 } else { longer };
        for i in 0..n {
            ahead[i] = next[i] + (next[i] - r[i]) * momentum;
            motion_ahead[i] = next_motion[i] + (next_motion[i] - motion[i]) * momentum;
            r[i] = next[i];
            motion[i] = next_motion[i];
            s[i] += slip_rate * (slip(i, &motion[i]) - s[i]);
        }
        let error = squared_length.sqrt() * lipschitz.max(1.0);
        lipschitz = CONTROL.least_lipschitz.max(lipschitz / CONTROL.longer);
        stale = if error < smallest { 0 } else { stale + 1 };
        smallest = smallest.min(error);
        if stale == CONTROL.patience {
            slip_rate = CONTROL.least_slip_rate.max(0.5 * slip_rate);
            stale = 0;
        }
        if schedule.is_due(monitor.iterations, error) || monitor.exhausted().is_some() {
            if let Some(status) = monitor.check(r) {
                return Some(status);
            }
            schedule.checked(monitor.iterations, error, monitor.residual());
        }
    }
    None
}
