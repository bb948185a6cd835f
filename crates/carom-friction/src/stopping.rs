//! When a solver stops, and what it says then.

use std::time::Duration;

use crate::clock::Clock;
use crate::residual::{Measured, Meter};
use crate::{ContactProblem, Criterion, Measure, SolverKind, Vector};

/// When to stop.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StoppingRule {
    /// Residual at which a problem counts as solved.
    pub tolerance: f64,
    /// In which units it has to be reached.
    pub criterion: Criterion,
    /// The stiffness that counts as 1 in the residual of published codes [N/m]: 1 where a problem is in their units.
    pub unit: f64,
    /// Iterations after which the solver gives up.
    pub max_iterations: usize,
    /// Time after which the solver gives up.
    pub time_limit: Option<Duration>,
}

impl Default for StoppingRule {
    fn default() -> Self {
        Self {
            tolerance: 1e-8,
            criterion: Criterion::default(),
            unit: 1.0,
            max_iterations: 100_000,
            time_limit: None,
        }
    }
}

impl StoppingRule {
    /// Starts the time.
    pub(crate) fn clock(&self) -> Clock {
        Clock::new(self.time_limit)
    }
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

/// Measures iterates and keeps the record of a solve; every solver ends in [`Monitor::report`], which trusts no one.
#[derive(Debug)]
pub(crate) struct Monitor<'a, const D: usize, P = ContactProblem<D>> {
    problem: &'a P,
    meter: Meter,
    rule: StoppingRule,
    clock: Clock,
    history: Vec<Sample>,
    /// Iterations made.
    pub iterations: usize,
}

impl<'a, const D: usize, P: Measured<D>> Monitor<'a, D, P> {
    pub fn new(problem: &'a P, rule: &StoppingRule, clock: Clock) -> Self {
        let (meter, history) = (problem.meter(rule.unit), Vec::with_capacity(32));
        Self { problem, meter, rule: *rule, clock, history, iterations: 0 }
    }

    /// The time the solve has.
    pub fn clock(&self) -> Clock {
        self.clock
    }

    /// Whether `r` is an answer; no one takes note of it.
    pub fn is_solved_by(&self, r: &[Vector<D>]) -> bool {
        self.problem.measure(&self.meter, r).decisive(self.rule.criterion) <= self.rule.tolerance
    }

    pub fn problem(&self) -> &'a P {
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
        let residual = self.problem.measure(&self.meter, r).decisive(self.rule.criterion);
        self.record(residual)
    }

    /// How many more iterations are needed if the residual falls on as between the last two checks; infinite where it does not.
    pub fn expected_iterations(&self) -> f64 {
        let Some(last) = self.history.last() else { return f64::INFINITY };
        let before = self.history.iter().rev().find(|sample| sample.iteration < last.iteration);
        let rate = before.map_or(0.0, |before| {
            (last.residual / before.residual).ln() / (last.iteration - before.iteration) as f64
        });
        if rate < 0.0 { (self.rule.tolerance / last.residual).ln() / rate } else { f64::INFINITY }
    }

    /// The residual of reactions `r` whose `motions` a solver knows.
    pub fn residual_of(&self, mu: &[f64], r: &[Vector<D>], motions: &[Vector<D>]) -> f64 {
        self.meter.measure(mu, r, |i| motions[i]).decisive(self.rule.criterion)
    }

    /// Enters a residual in the history.
    pub fn note(&mut self, residual: f64) {
        self.history.push(Sample { iteration: self.iterations, residual });
    }

    fn record(&mut self, residual: f64) -> Option<SolveStatus> {
        self.note(residual);
        if residual <= self.rule.tolerance {
            Some(SolveStatus::Solved)
        } else if !residual.is_finite() {
            Some(SolveStatus::Diverged)
        } else {
            self.exhausted()
        }
    }

    /// Whether iterations or time ran out.
    pub fn exhausted(&self) -> Option<SolveStatus> {
        self.exhausted_after(0)
    }

    /// Whether iterations or time have run out after so many `more` iterations than are counted.
    pub fn exhausted_after(&self, more: usize) -> Option<SolveStatus> {
        if self.iterations.saturating_add(more) >= self.rule.max_iterations {
            Some(SolveStatus::IterationLimit)
        } else if self.clock.is_over() {
            Some(SolveStatus::TimeLimit)
        } else {
            None
        }
    }

    /// The report on the answer `r`. It is measured once more: nothing else can make it a success.
    pub fn report(mut self, solver: SolverKind, status: SolveStatus, r: &[Vector<D>]) -> SolveReport {
        let measure = self.problem.measure(&self.meter, r);
        let residual = measure.decisive(self.rule.criterion);
        let status = if residual <= self.rule.tolerance {
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
            time: self.clock.elapsed(),
        }
    }
}
