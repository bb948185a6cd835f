use crate::schedule::Schedule;
use crate::stopping::Monitor;
use crate::{
    ContactProblem, FrictionSolver, SolveReport, SolveStatus, SolverKind, StoppingRule, Vector, cone, scaled,
};

/// The bi-potential iteration of de Saxcé and Feng on all contacts at once, r_i ← proj_K(r_i − θ ρ_i (w_i + μ|w_t| n)) with
/// ρ_i = 1/λ_max(W_ii), whose factor θ adapts itself.
///
/// θ is in turn the longer and the shorter step of J. Barzilai and J. M. Borwein [IMA J. Numer. Anal. 8 (1988) 141–148; Y.-H. Dai,
/// R. Fletcher, Numer. Math. 100 (2005) 21–47 for projected steps], which follow the spectrum of W. No function needs to fall on
/// the way. Where nothing is gained for long, the iteration goes back to its best point and takes cautious steps for a while. None
/// is longer than the motions' change allows [B. He, L.-Z. Liao, J. Optim. Theory Appl. 112 (2002) 111–128].
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Uzawa;

/// How long steps are, and when they become cautious.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Control {
    /// Iterations without progress that are borne, at first.
    patience: usize,
    /// Growth of the error, over the smallest, that is not borne at all.
    blow_up: f64,
    /// Largest θ: where reactions are free to grow no motion bounds it.
    largest: f64,
    /// Lipschitz ratio θ ‖ΔF‖/‖Δr‖ above which a cautious step is taken again.
    long: f64,
    /// The same ratio below which the next cautious step is longer.
    short: f64,
}

/// The thresholds of every run.
const CONTROL: Control = Control { patience: 800, blow_up: 1e6, largest: 1e4, long: 0.9, short: 0.4 };

impl<const D: usize> FrictionSolver<D> for Uzawa {
    fn solve(&self, problem: &ContactProblem<D>, r: &mut [Vector<D>], rule: &StoppingRule) -> SolveReport {
        scaled::solve(problem, r, rule, |monitor, r| {
            (SolverKind::Uzawa, run(monitor, r, usize::MAX).unwrap_or(SolveStatus::Stalled))
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
    let rho = problem.step_lengths();
    problem.bring_into_cones(rho.iter().copied(), r);
    if let Some(status) = monitor.check(r) {
        return Some(status);
    }
    let mut force = vec![Vector::zeros(); problem.len()];
    let (mut next, mut next_force) = (r.to_vec(), force.clone());
    motions(problem, r, &mut force);
    let (mut best, mut best_error) = (r.to_vec(), f64::INFINITY);
    let (mut theta, mut cautious, mut patience, mut stale) = (1.0, 0, CONTROL.patience, 0);
    let mut schedule = Schedule::new(monitor.tolerance(), monitor.iterations);
    let last = monitor.iterations.saturating_add(max_iterations);
    while monitor.iterations < last {
        for i in 0..r.len() {
            next[i] = cone::project(&(r[i] - force[i] * (theta * rho[i])), problem.mu[i]);
        }
        motions(problem, &next, &mut next_force);
        monitor.iterations += 1;
        let step = Step::between(&rho, (r, &next), (&force, &next_force));
        let ratio = theta * (step.squared_change / step.squared_length).sqrt();
        if cautious > 0 && ratio > CONTROL.long && monitor.exhausted().is_none() {
            theta *= 2.0 / 3.0 / ratio.max(1.0);
            continue;
        }
        // A bound of the natural residual: a projected step grows with θ, but no faster.
        let error = step.squared_length.sqrt() / theta.min(1.0);
        if !error.is_finite() {
            r.copy_from_slice(&best);
            return Some(SolveStatus::Diverged);
        }
        if cautious > 0 {
            cautious -= 1;
            if ratio < CONTROL.short {
                theta *= 1.5;
            }
        } else {
            theta = step.spectral(monitor.iterations % 2 == 0).unwrap_or(theta).min(CONTROL.largest);
        }
        if error < best_error {
            (best_error, stale) = (error, 0);
            best.copy_from_slice(r);
        } else {
            stale += 1;
        }
        r.copy_from_slice(&next);
        std::mem::swap(&mut force, &mut next_force);
        if cautious == 0 && (stale > patience || error > CONTROL.blow_up * best_error) {
            r.copy_from_slice(&best);
            motions(problem, r, &mut force);
            theta = 1.0;
            (stale, cautious) = (0, patience);
            patience *= 2;
        }
        if schedule.is_due(monitor.iterations, error) || monitor.exhausted().is_some() {
            if let Some(status) = monitor.check(r) {
                return Some(status);
            }
            if step.squared_length == 0.0 {
                return Some(SolveStatus::Stalled);
            }
            schedule.checked(monitor.iterations, error, monitor.residual());
        }
    }
    None
}

/// F_i = w_i + μ|w_t| n of all contacts.
fn motions<const D: usize>(problem: &ContactProblem<D>, r: &[Vector<D>], force: &mut [Vector<D>]) {
    problem.w.each_row_times(r, force, |i, moved| {
        let mut f = problem.q[i] + moved;
        f[0] += problem.mu[i] * cone::tangential_norm(&f);
        f
    });
}

/// Products of a step Δr and the change ΔF along it, weighted with ρ_i so that all are in the same unit.
#[derive(Debug, Clone, Copy, Default)]
struct Step {
    /// Σ |Δr|²/ρ.
    squared_length: f64,
    /// Σ ρ |ΔF|².
    squared_change: f64,
    /// Σ Δr·ΔF.
    product: f64,
}

impl Step {
    fn between<const D: usize>(
        rho: &[f64],
        r: (&[Vector<D>], &[Vector<D>]),
        force: (&[Vector<D>], &[Vector<D>]),
    ) -> Self {
        let mut step = Self::default();
        for i in 0..rho.len() {
            if rho[i] > 0.0 {
                let (dr, df) = (r.1[i] - r.0[i], force.1[i] - force.0[i]);
                step.squared_length += dr.norm_squared() / rho[i];
                step.squared_change += df.norm_squared() * rho[i];
                step.product += dr.dot(&df);
            }
        }
        step
    }

    /// The factor with which θ ΔF comes closest to Δr, or Δr/θ to ΔF: the longer one; their mean where Δr and ΔF disagree.
    fn spectral(&self, longer: bool) -> Option<f64> {
        let theta = match (self.product > 0.0, longer) {
            (true, true) => self.squared_length / self.product,
            (true, false) => self.product / self.squared_change,
            (false, _) => (self.squared_length / self.squared_change).sqrt(),
        };
        (theta > 0.0 && theta.is_finite()).then_some(theta)
    }
}
