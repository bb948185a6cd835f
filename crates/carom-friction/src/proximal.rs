use crate::block_lu::NoStructure;
use crate::contradiction::contradicts;
use crate::equation::Equation;
use crate::newton::{Newton, Shifted};
use crate::residual::LARGEST_REACTIONS;
use crate::stopping::Monitor;
use crate::{
    ContactProblem, FrictionSolver, SolveReport, SolveStatus, SolverKind, StoppingRule, Vector, cone, scaled,
};

/// The proximal point method: W + shift I instead of W, around the last answer, solved by Newton's iterations
/// [R. T. Rockafellar, SIAM J. Control Optim. 14 (1976) 877–898].
///
/// The shift falls as quickly as Newton's method can follow and rises where it cannot. There the other form of the contact
/// laws is tried too, since what traps one seldom traps both.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Proximal;

/// Semismooth Newton on the contact laws themselves, in the form of Alart and Curnier. Where that fails, its globalisation is
/// the proximal point method, from small shifts to larger ones.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct NewtonAlartCurnier;

/// Semismooth Newton on the bi-potential's natural map, globalised in the same way.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct NewtonNaturalMap;

impl<const D: usize> FrictionSolver<D> for Proximal {
    fn solve(&self, problem: &ContactProblem<D>, r: &mut [Vector<D>], rule: &StoppingRule) -> SolveReport {
        Strategy::PROXIMAL.solve(SolverKind::Proximal, problem, r, rule)
    }
}

impl<const D: usize> FrictionSolver<D> for NewtonAlartCurnier {
    fn solve(&self, problem: &ContactProblem<D>, r: &mut [Vector<D>], rule: &StoppingRule) -> SolveReport {
        Strategy::NEWTON.solve(SolverKind::NewtonAlartCurnier, problem, r, rule)
    }
}

impl<const D: usize> FrictionSolver<D> for NewtonNaturalMap {
    fn solve(&self, problem: &ContactProblem<D>, r: &mut [Vector<D>], rule: &StoppingRule) -> SolveReport {
        let equations = &[Equation::NaturalMap];
        let strategy = Strategy { equations, first_shift: CONTROL.nearly_none, step: 1.0 };
        strategy.solve(SolverKind::NewtonNaturalMap, problem, r, rule)
    }
}

/// How the shift, relative to the mean compliance tr W/(n D), follows Newton's method.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Control {
    /// A first shift that only keeps redundant contacts from a singular matrix.
    nearly_none: f64,
    /// With this one Newton's method converges from almost any start.
    safe: f64,
    /// With this one the contacts hardly feel one another: larger ones are of no use.
    largest: f64,
    /// The smallest shift.
    smallest: f64,
    /// Iterations after which Newton's method is thought to be trapped: where it converges it takes four to eight.
    trapped: usize,
    /// Growth of the shift when it is.
    growth: f64,
    /// Cautious decreases after that.
    caution: u32,
    /// Factor of the shift where Newton's method only just follows.
    slow: f64,
    /// ‖φ‖ that is small enough in a step, relative to the residual before it.
    inner: f64,
    /// The step ρ in piles, relative to 1/λ_max(W_ii). There a contact answers to many others, and by a short step Newton's method guesses better which
    /// of them slip. Measured on the problems of a pile of 1,000 discs: with 1 it takes 1.5 times the iterations.
    short: f64,
}

/// The thresholds of every run.
const CONTROL: Control = Control {
    nearly_none: 1e-10,
    safe: 0.1,
    largest: 1.0,
    smallest: 1e-14,
    trapped: 10,
    growth: 5.0,
    caution: 2,
    slow: 0.7,
    inner: 1e-2,
    short: 0.1,
};

/// How the method is run.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Strategy {
    /// Forms of the laws, in the order in which they are tried.
    equations: &'static [Equation],
    /// Relative to the mean compliance.
    first_shift: f64,
    /// ρ of the equations, relative to 1/λ_max(W_ii).
    step: f64,
}

impl Strategy {
    pub const NEWTON: Self =
        Self { equations: &[Equation::AlartCurnier], first_shift: CONTROL.nearly_none, step: 1.0 };
    pub const PILE: Self =
        Self { equations: &[Equation::NaturalMap], first_shift: CONTROL.nearly_none, step: CONTROL.short };
    pub const PROXIMAL: Self = Self {
        equations: &[Equation::NaturalMap, Equation::AlartCurnier],
        first_shift: CONTROL.safe,
        step: 1.0,
    };

    fn solve<const D: usize>(
        self,
        kind: SolverKind,
        problem: &ContactProblem<D>,
        r: &mut [Vector<D>],
        rule: &StoppingRule,
    ) -> SolveReport {
        scaled::solve(problem, r, rule, |monitor, r| {
            if let Some(status) = monitor.check(r) {
                return (kind, status);
            }
            let status = match Newton::new(monitor.problem(), usize::MAX, monitor.clock()) {
                Ok(mut newton) => self.run(monitor, &mut newton, r, usize::MAX),
                Err(NoStructure::TimeIsUp) => SolveStatus::TimeLimit,
                Err(NoStructure::TooLarge) => SolveStatus::Stalled,
            };
            (kind, status)
        })
    }

    /// Improves `r`, which was measured, until the problem is solved or `max_iterations` more are made.
    pub fn run<const D: usize>(
        self,
        monitor: &mut Monitor<'_, D>,
        newton: &mut Newton<D>,
        r: &mut [Vector<D>],
        max_iterations: usize,
    ) -> SolveStatus {
        let problem = monitor.problem();
        let mut rho = problem.step_lengths();
        rho.iter_mut().for_each(|rho| *rho *= self.step);
        let mean_compliance = 1.0 / monitor.stiffness();
        let motion_force = monitor.stiffness() * norm(&problem.q);
        let end = monitor.iterations.saturating_add(max_iterations);
        let (mut shift, mut form, mut caution) = (self.first_shift, 0, 0u32);
        // ‖φ‖ weighs every contact with its own ρ, the residual all alike: how small is enough turns out on the way.
        let mut strictness = 1.0;
        let mut centre = r.to_vec();
        let mut trial = r.to_vec();
        loop {
            let size = motion_force.max(norm(r));
            let wanted = strictness
                * (0.1 * monitor.tolerance()).max(CONTROL.inner * monitor.residual().min(0.1))
                * size;
            trial.copy_from_slice(r);
            let shifted = Shifted { problem, rho: &rho, shift: shift * mean_compliance, centre: &centre };
            let goes_on = |made| made < CONTROL.trapped && monitor.exhausted_after(made).is_none();
            let newton_end = newton.solve(&shifted, self.equations[form], &mut trial, wanted, goes_on);
            monitor.iterations += newton_end.iterations;
            if newton_end.converged {
                for i in 0..r.len() {
                    r[i] = cone::project(&trial[i], problem.mu[i]);
                }
                if let Some(status) = monitor.check(r) {
                    return status;
                }
                // Reactions out of proportion make one ask whether there are any that suffice.
                if norm(r) > LARGEST_REACTIONS * motion_force
                    && contradicts(problem, r, &centre, monitor.stiffness(), &mut newton.lu, monitor.clock())
                {
                    return SolveStatus::Inconsistent;
                }
                centre.copy_from_slice(r);
                if newton_end.iterations == 0 {
                    strictness *= 0.1;
                    if strictness < f64::EPSILON {
                        return SolveStatus::Stalled;
                    }
                }
                let decrease = match newton_end.iterations {
                    0..=3 => 0.1,
                    4..=8 => 0.4,
                    _ => CONTROL.slow,
                };
                shift = (shift * if caution > 0 { decrease.max(CONTROL.slow) } else { decrease })
                    .max(CONTROL.smallest);
                caution = caution.saturating_sub(1);
            } else if newton_end.iterations == 0 && monitor.exhausted().is_none() {
                // What is too large for its square is no start, whatever the shift.
                return SolveStatus::Stalled;
            } else {
                shift = match shift {
                    _ if shift <= CONTROL.nearly_none => CONTROL.safe,
                    _ if shift < CONTROL.largest => shift * CONTROL.growth,
                    _ => CONTROL.safe,
                };
                form = (form + 1) % self.equations.len();
                caution = CONTROL.caution;
            }
            if let Some(status) = monitor.exhausted() {
                return status;
            }
            if monitor.iterations >= end {
                return SolveStatus::IterationLimit;
            }
        }
    }
}

fn norm<const D: usize>(x: &[Vector<D>]) -> f64 {
    x.iter().map(Vector::norm_squared).sum::<f64>().sqrt()
}
