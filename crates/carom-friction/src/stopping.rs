//! When a solver stops, and what it says then.

use std::time::{Duration, Instant};

use crate::{ContactProblem, Measure, SolverKind, Vector, residual::Meter};

/// When to stop.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StoppingRule {
    /// Residual at which a problem counts as solved.
    pub tolerance: f64,
    /// In which units it has to be reached.
    pub criterion: Criterion,
    /// Iterations after which the solver gives up.
    pub max_iterations: usize,
    /// Time after which the solver gives up.
    pub time_limit: Option<Duration>,
}

impl Default for StoppingRule {
    fn default() -> Self {
        Self { tolerance: 1e-8, criterion: Criterion::default(), max_iterations: 100_000, time_limit: None }
    }
}

/// In which units the residual has to be below the tolerance (see [`Measure`]).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Criterion {
    /// In the units of the problem, as published codes compare themselves, and in its natural ones.
    #[default]
    Both,
    /// In the natural units of the problem alone, so that the answer does not depend on the choice of units.
    Natural,
}

/// How a solve ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SolveStatus {
    /// The residual is at or below the tolerance.
    Solved,
    /// The iterations ran out.
    IterationLimit,
    /// The time ran out.
    TimeLimit,
    /// No step of the method improved the answer any more.
    Stalled,
    /// No reactions can keep the contacts apart: the data contradict themselves.
    Inconsistent,
    /// An iterate was not a finite number.
    Diverged,
}

impl SolveStatus {
    /// The status as a word.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            SolveStatus::Solved => "solved",
            SolveStatus::IterationLimit => "iteration-limit",
            SolveStatus::TimeLimit => "time-limit",
            SolveStatus::Stalled => "stalled",
            SolveStatus::Inconsistent => "inconsistent",
            SolveStatus::Diverged => "diverged",
        }
    }
}

/// A residual on the way to the answer.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sample {
    /// Iterations made.
    pub iteration: usize,
    /// The residual that the tolerance is compared with.
    pub residual: f64,
}

/// What a solver says about its answer.
#[derive(Debug, Clone, PartialEq)]
pub struct SolveReport {
    /// How it ended.
    pub status: SolveStatus,
    /// The solver that gave the answer: for `auto` the one it ended with.
    pub solver: SolverKind,
    /// Iterations: sweeps over all contacts, or linear systems for Newton's method.
    pub iterations: usize,
    /// Distance of the answer from the law, computed anew from it.
    pub measure: Measure,
    /// The residuals measured on the way.
    pub history: Vec<Sample>,
    /// Time taken.
    pub time: Duration,
}

impl SolveReport {
    /// Whether the answer is a solution.
    #[must_use]
    pub fn is_solved(&self) -> bool {
        self.status == SolveStatus::Solved
    }
}

/// Reactions, relative to what the motions without them call for, from which on a small residual proves nothing.
const FAR: f64 = 1e3;
/// Error of the motions that is acceptable there, relative to the motions without reactions.
const MOTION_ERROR: f64 = 1e-4;
/// Reactions beside which round-off hides what the motions are.
const TOO_FAR: f64 = 1e12;

/// Measures iterates and keeps the record of a solve; every solver ends in [`Monitor::report`], which trusts no one.
#[derive(Debug)]
pub(crate) struct Monitor<'a, const D: usize> {
    problem: &'a ContactProblem<D>,
    meter: Meter,
    rule: StoppingRule,
    start: Instant,
    history: Vec<Sample>,
    /// Iterations made.
    pub iterations: usize,
}

impl<'a, const D: usize> Monitor<'a, D> {
    pub fn new(problem: &'a ContactProblem<D>, rule: &StoppingRule) -> Self {
        let (meter, history) = (Meter::new(problem), Vec::with_capacity(32));
        Self { problem, meter, rule: *rule, start: Instant::now(), history, iterations: 0 }
    }

    pub fn problem(&self) -> &'a ContactProblem<D> {
        self.problem
    }

    pub fn tolerance(&self) -> f64 {
        self.rule.tolerance
    }

    /// The natural unit of stiffness [N/m] (see [`Measure`]).
    pub fn stiffness(&self) -> f64 {
        self.meter.stiffness
    }

    /// The last residual measured.
    pub fn residual(&self) -> f64 {
        self.history.last().map_or(f64::INFINITY, |s| s.residual)
    }

    /// Measures `r`; whether it is time to stop, and why.
    pub fn check(&mut self, r: &[Vector<D>]) -> Option<SolveStatus> {
        let measure = self.meter.measure(self.problem, r);
        let residual = measure.decisive(self.rule.criterion);
        self.history.push(Sample { iteration: self.iterations, residual });
        if self.is_solved(&measure, r) {
            Some(SolveStatus::Solved)
        } else if !residual.is_finite() {
            Some(SolveStatus::Diverged)
        } else {
            self.exhausted()
        }
    }

    /// Whether the residual is small, and not only in comparison with reactions that grow without bound, as they do where the data
    /// contradict themselves: beyond [`FAR`] the motions have to obey the law by themselves.
    fn is_solved(&self, measure: &Measure, r: &[Vector<D>]) -> bool {
        let norm = |x: &[Vector<D>]| x.iter().map(Vector::norm_squared).sum::<f64>().sqrt();
        let (reactions, motions) = (norm(r), self.meter.stiffness * norm(&self.problem.q));
        measure.decisive(self.rule.criterion) <= self.rule.tolerance
            && (motions == 0.0
                || reactions <= FAR * motions
                || reactions <= TOO_FAR * motions
                    && measure.natural_residual * reactions <= MOTION_ERROR * motions)
    }

    /// Whether iterations or time ran out.
    pub fn exhausted(&self) -> Option<SolveStatus> {
        if self.iterations >= self.rule.max_iterations {
            Some(SolveStatus::IterationLimit)
        } else if self.rule.time_limit.is_some_and(|limit| self.start.elapsed() >= limit) {
            Some(SolveStatus::TimeLimit)
        } else {
            None
        }
    }

    /// The report on the answer `r`. It is measured once more: nothing else can make it a success.
    pub fn report(mut self, solver: SolverKind, status: SolveStatus, r: &[Vector<D>]) -> SolveReport {
        let measure = self.meter.measure(self.problem, r);
        let residual = measure.decisive(self.rule.criterion);
        let status = if self.is_solved(&measure, r) {
            SolveStatus::Solved
        } else if !residual.is_finite() {
            SolveStatus::Diverged
        } else if status == SolveStatus::Solved {
            SolveStatus::Stalled
        } else {
            status
        };
        if self.history.last().is_none_or(|s| s.residual != residual) {
            self.history.push(Sample { iteration: self.iterations, residual });
        }
        SolveReport {
            status,
            solver,
            iterations: self.iterations,
            measure,
            history: self.history,
            time: self.start.elapsed(),
        }
    }
}
