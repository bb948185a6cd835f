use crate::anderson::Anderson;
use crate::local::{AlartCurnier, Bipotential, Enumerative, LocalContact, LocalSolver};
use crate::schedule::Schedule;
use crate::stopping::Monitor;
use crate::{
    ContactProblem, FrictionSolver, SolveReport, SolveStatus, SolverKind, StoppingRule, Vector, cone, scaled,
};

/// Block Gauss–Seidel: contact after contact, each with the present reactions of the others
/// [M. Jean, Comput. Methods Appl. Mech. Engrg. 177 (1999) 235–257].
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct GaussSeidel {
    /// How a single contact is solved.
    pub local: Local,
}

/// Solvers of a single contact.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Local {
    /// The bi-potential fixed point with ρ_i = 1/λ_max(W_ii).
    #[default]
    Bipotential,
    /// Separation, stick and slip by closed forms, in 3D with a quartic.
    Enumerative,
    /// Semismooth Newton on Alart and Curnier's equation.
    AlartCurnier,
}

impl<const D: usize> FrictionSolver<D> for GaussSeidel {
    fn solve(&self, problem: &ContactProblem<D>, r: &mut [Vector<D>], rule: &StoppingRule) -> SolveReport {
        scaled::solve(problem, r, rule, |monitor, r| {
            let (kind, status) = match self.local {
                Local::Bipotential => {
                    (SolverKind::GaussSeidel, run::<D, Bipotential>(monitor, r, usize::MAX))
                }
                Local::Enumerative => {
                    (SolverKind::GaussSeidelEnumerative, run::<D, Enumerative>(monitor, r, usize::MAX))
                }
                Local::AlartCurnier => {
                    (SolverKind::GaussSeidelAlartCurnier, run::<D, AlartCurnier>(monitor, r, usize::MAX))
                }
            };
            (kind, status.unwrap_or(SolveStatus::Stalled))
        })
    }
}

/// When sweeps are damped.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Control {
    /// Checks without a new smallest residual after which the sweeps are damped: exact local answers may chase one another in circles.
    patience: usize,
    /// What remains of the relaxation then.
    damping: f64,
    /// The least of it.
    least_relaxation: f64,
}

/// The thresholds of every run.
const CONTROL: Control = Control { patience: 10, damping: 0.7, least_relaxation: 0.5 };

/// Sweeps until it is time to stop, or `max_sweeps` times: then None.
pub(crate) fn run<const D: usize, L: LocalSolver<D>>(
    monitor: &mut Monitor<'_, D>,
    r: &mut [Vector<D>],
    max_sweeps: usize,
) -> Option<SolveStatus> {
    let problem = monitor.problem();
    let contacts: Vec<LocalContact<D>> = (0..problem.len()).map(|i| LocalContact::new(problem, i)).collect();
    problem.bring_into_cones(contacts.iter().map(|c| c.rho), r);
    if let Some(status) = monitor.check(r) {
        return Some(status);
    }
    // With these weights lengths count as energies do, whatever the units of a contact.
    let weight = |c: &LocalContact<D>| if c.rho > 0.0 { 1.0 / c.rho.sqrt() } else { 0.0 };
    let mut anderson = Anderson::new(contacts.iter().map(weight).collect());
    let mut before = r.to_vec();
    let accuracy = 0.1 * monitor.tolerance();
    let mut schedule = Schedule::new(monitor.tolerance(), monitor.iterations);
    let last = monitor.iterations.saturating_add(max_sweeps);
    let (mut relaxation, mut smallest, mut stale) = (1.0, f64::INFINITY, 0);
    while monitor.iterations < last {
        if anderson.is_active() {
            before.copy_from_slice(r);
        }
        let mut change = 0.0;
        for (i, contact) in contacts.iter().enumerate() {
            let old = r[i];
            let free = problem.q[i] + problem.w.row_times_others(i, r);
            // Open contacts stay so, and no reaction helps one that nothing can move.
            if old[0] == 0.0 && (free[0] >= 0.0 || contact.rho == 0.0) {
                continue;
            }
            r[i] = old + (L::solve(contact, &free, &old, accuracy) - old) * relaxation;
            change += (r[i] - old).norm_squared();
        }
        if anderson.is_active() {
            anderson.accelerate(&before, r);
            for (r, &mu) in r.iter_mut().zip(&problem.mu) {
                *r = cone::project(r, mu);
            }
        }
        monitor.iterations += 1;
        if schedule.is_due(monitor.iterations, change.sqrt()) || monitor.exhausted().is_some() {
            if let Some(status) = monitor.check(r) {
                return Some(status);
            }
            schedule.checked(monitor.iterations, change.sqrt(), monitor.residual());
            stale = if monitor.residual() < smallest { 0 } else { stale + 1 };
            smallest = smallest.min(monitor.residual());
            if stale == CONTROL.patience {
                relaxation = CONTROL.least_relaxation.max(CONTROL.damping * relaxation);
                stale = 0;
            }
        }
    }
    None
}

/// What a sweep costs, in products of blocks.
pub(crate) fn cost<const D: usize>(problem: &ContactProblem<D>) -> usize {
    problem.w.block_count() + 10 * problem.len()
}
