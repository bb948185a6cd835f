use crate::penalised::Penalised;
use crate::schedule::Schedule;
use crate::stopping::Monitor;
use crate::{
    ContactProblem, FrictionSolver, SolveReport, SolveStatus, SolverKind, StoppingRule, Vector, cone,
};

/// The alternating direction method of multipliers on the convex problem min ½ x·W x + x·(q + s n) with x = r in K, whose slip
/// s = μ|w_t| follows the multipliers [S. Boyd et al., Found. Trends Mach. Learn. 3 (2011) 1–122, with over-relaxation, § 3.4.3].
///
/// Every iteration solves with one factor of W + θ P, where P_i = λ_max(W_ii) weighs the contacts; θ balances the residuals of
/// x = r and of the motions, and is changed, with a new factor, ever less often, since the method converges for a fixed one.
/// W need not be symmetric.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Admm;

/// Penalty θ at first, over-relaxation, and share of its change by which s follows.
const PENALTY: f64 = 0.05;
const RELAXATION: f64 = 1.5;
const SLIP_RATE: f64 = 1.0;
const LEAST_SLIP_RATE: f64 = 0.01;
/// Iterations without progress after which over-relaxation is given up, and then s follows half as fast.
const PATIENCE: usize = 200;
/// Ratio of the two residuals from which θ is changed, iterations before it is first looked at, and their growth.
const IMBALANCE: f64 = 2.0;
const TRIAL: f64 = 20.0;
const TRIAL_GROWTH: f64 = 1.2;
/// Bounds of θ: reactions that are free to grow would let it fall for ever, and no pivot is too small with a large one.
const LEAST_PENALTY: f64 = 1e-6;
const LARGEST_PENALTY: f64 = 1e6;

impl<const D: usize> FrictionSolver<D> for Admm {
    fn solve(&self, problem: &ContactProblem<D>, r: &mut [Vector<D>], rule: &StoppingRule) -> SolveReport {
        let mut monitor = Monitor::new(problem, rule);
        let status = run(&mut monitor, r, usize::MAX);
        monitor.report(SolverKind::Admm, status.unwrap_or(SolveStatus::Stalled), r)
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
    let rho: Vec<f64> = (0..n).map(|i| problem.step_length(i)).collect();
    for (i, r) in r.iter_mut().enumerate() {
        *r = if rho[i] > 0.0 { cone::project(r, problem.mu[i]) } else { Vector::zeros() };
    }
    if let Some(status) = monitor.check(r) {
        return Some(status);
    }
    // A contact that nothing can move has no reaction; its place in the linear systems is kept by any weight.
    let weight: Vec<f64> =
        rho.iter().map(|&rho| if rho > 0.0 { 1.0 / rho } else { 1.0 / monitor.stiffness() }).collect();
    let mut system = Penalised::new(problem)?;
    let mut theta = factorize(&mut system, &weight, PENALTY)?;
    // The state v = r + u is the reaction with the multiplier u = −(w + s n)/(θ P), which is in the polar cone of K.
    let (mut slip, mut v) = (vec![0.0; n], r.to_vec());
    for i in 0..n {
        let mut force = problem.motion(i, r);
        slip[i] = problem.mu[i] * cone::tangential_norm(&force);
        force[0] += slip[i];
        let u = force * (-1.0 / (theta * weight[i]));
        v[i] += u - cone::project(&u, problem.mu[i]);
    }
    let mut x = r.to_vec();
    let (mut relaxation, mut slip_rate) = (RELAXATION, SLIP_RATE);
    let (mut smallest, mut stale) = (f64::INFINITY, 0);
    let (mut trial, mut tried) = (TRIAL, 0.0);
    let mut schedule = Schedule::new(monitor.tolerance(), monitor.iterations);
    let last = monitor.iterations.saturating_add(max_iterations);
    while monitor.iterations < last {
        for i in 0..n {
            let penalty = theta * weight[i];
            let u = v[i] - r[i];
            slip[i] += slip_rate * (problem.mu[i] * cone::tangential_norm(&u) * penalty - slip[i]);
            x[i] = (r[i] - u) * penalty - problem.q[i];
            x[i][0] -= slip[i];
        }
        system.solve(&mut x);
        let (mut squared_length, mut primal, mut dual) = (0.0, 0.0, 0.0);
        for i in 0..n {
            if rho[i] == 0.0 {
                continue;
            }
            let move_x = x[i] - r[i];
            v[i] += move_x * relaxation;
            let next = cone::project(&v[i], problem.mu[i]);
            squared_length += move_x.norm_squared() * weight[i];
            primal += (x[i] - next).norm_squared() * weight[i];
            dual += (next - r[i]).norm_squared() * weight[i];
            r[i] = next;
        }
        monitor.iterations += 1;
        let error = squared_length.sqrt();
        if schedule.is_due(monitor.iterations, error) || monitor.exhausted().is_some() {
            if let Some(status) = monitor.check(r) {
                return Some(status);
            }
            schedule.checked(monitor.iterations, error, monitor.residual());
        }
        stale = if error < smallest { 0 } else { stale + 1 };
        smallest = smallest.min(error);
        if stale == PATIENCE {
            if relaxation > 1.0 {
                relaxation = 1.0;
            } else {
                slip_rate = LEAST_SLIP_RATE.max(0.5 * slip_rate);
            }
            stale = 0;
        }
        tried += 1.0;
        let imbalance = (primal / dual).sqrt();
        let is_balanced = (1.0 / IMBALANCE..=IMBALANCE).contains(&imbalance);
        if tried >= trial && !is_balanced && imbalance > 0.0 && imbalance.is_finite() {
            let wanted = (theta * imbalance.sqrt().clamp(0.05, 20.0)).max(LEAST_PENALTY);
            let before = std::mem::replace(&mut theta, factorize(&mut system, &weight, wanted)?);
            for (v, r) in v.iter_mut().zip(&*r) {
                *v = r + (*v - r) * (before / theta);
            }
            (trial, tried) = (trial * TRIAL_GROWTH, 0.0);
            (smallest, stale) = (f64::INFINITY, 0);
        }
    }
    None
}

/// Factorises W + θ P, with a larger θ where a pivot is too small, and returns θ.
fn factorize<const D: usize>(system: &mut Penalised<'_, D>, weight: &[f64], mut theta: f64) -> Option<f64> {
    while theta <= LARGEST_PENALTY {
        if system.factorize(|i| theta * weight[i]) {
            return Some(theta);
        }
        theta *= 10.0;
    }
    None
}
