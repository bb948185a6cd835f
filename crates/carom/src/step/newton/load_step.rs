//! When the iterations of a load step have ended, and when they lead astray.
//!
//! A load step is solved by Newton's method: K̄ is the tangent at the last guess, and the contact problem takes part in every iteration as it is,
//! inequalities and all (Josephy–Newton), so that iterations converge as those without contact do. Far from the solution a tangent may lead
//! anywhere or have no inverse. There corrections are held back towards the last guess by a share of the body's inertia, more of it after
//! every guess that was worse than the one before (Levenberg & Marquardt; for contact see Kanzow, Yamashita & Fukushima 2002).

use super::control::LOAD_STEP;
use crate::error::StepError;

/// What becomes of a correction.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Verdict {
    /// It is applied and the last one.
    Last,
    /// It is applied, and the tangent that gave it is good for more.
    Applied,
    /// It is applied, and a new tangent made where it leads.
    Renewed,
    /// The guess that it was computed at was a bad one.
    Refused,
}

/// The iterations of some bodies in a load step.
#[derive(Debug, Clone, Copy)]
pub(crate) struct LoadStep {
    /// Largest correction that may be left, relative to what the model has moved since the start.
    pub tolerance: f64,
    pub max_iterations: usize,
    /// How many iterations with a kept tangent a new one is worth.
    pub worth: i32,
    /// The largest displacement at the start of the step [m].
    pub reached: f64,
    /// The last correction that was applied [m], and the largest motion or correction of the step so far.
    pub last: f64,
    /// What the last correction was of the one before.
    contraction: f64,
    reach: f64,
    /// The smallest correction so far [m], and the iterations since.
    least: f64,
    stalled: usize,
    refused: usize,
}

impl LoadStep {
    /// Of a step that the model enters with displacements of up to `reached` [m].
    pub fn new(tolerance: f64, max_iterations: usize, worth: i32, reached: f64) -> Self {
        Self {
            tolerance,
            max_iterations,
            worth,
            reached,
            last: f64::INFINITY,
            contraction: 0.0,
            reach: 0.0,
            least: f64::INFINITY,
            stalled: 0,
            refused: 0,
        }
    }

    /// The correction that may be left where the step has moved nodes by up to `motion` [m] and round-off by `round_off` [m].
    fn wanted(&self, motion: f64, round_off: f64) -> f64 {
        (self.tolerance * motion.max(self.reached)).max(round_off)
    }

    /// Judges a `correction` [m] of a guess that has moved nodes by up to `motion` [m].
    ///
    /// # Errors
    /// If there have been too many.
    pub fn judge(
        &mut self,
        iteration: usize,
        correction: f64,
        motion: f64,
        round_off: f64,
    ) -> Result<Verdict, StepError> {
        let wanted = self.wanted(motion, round_off);
        let failed = StepError::Newton { iterations: iteration, correction, wanted };
        let is_first = self.last.is_infinite();
        self.reach = self.reach.max(motion);
        if !correction.is_finite() || !is_first && correction > LOAD_STEP.astray * self.reach {
            return self.refuse(failed).map(|()| Verdict::Refused);
        }
        let contraction = if is_first { 1.0 } else { correction / self.last };
        self.reach = self.reach.max(correction);
        self.last = correction;
        self.contraction = contraction;
        if correction <= 0.5 * self.least {
            (self.least, self.stalled) = (correction, 0);
        } else {
            self.stalled += 1;
        }
        let left = (LOAD_STEP.safety * contraction).min(1.0);
        let is_round_off = self.has_stalled() && correction <= LOAD_STEP.unavoidable * round_off;
        if correction * left <= wanted || is_round_off {
            return Ok(Verdict::Last);
        }
        if iteration >= self.max_iterations {
            return Err(failed);
        }
        let expected = if is_first { LOAD_STEP.hoped } else { contraction };
        let is_fast = correction * expected.powi(self.worth) <= wanted;
        Ok(if is_fast { Verdict::Applied } else { Verdict::Renewed })
    }

    /// Takes note that from now on corrections leave something out: they say nothing of those before.
    pub fn has_other_corrections(&mut self) {
        (self.last, self.least, self.stalled) = (f64::INFINITY, f64::INFINITY, 0);
    }

    /// Whether corrections do not shrink.
    pub fn has_stalled(&self) -> bool {
        self.stalled >= LOAD_STEP.stalled
    }

    /// Whether what is left is small beside what the step has moved.
    pub fn is_near(&self) -> bool {
        self.last <= LOAD_STEP.near * self.reach
    }

    /// Whether corrections shrink no faster than they would by a tangent that lacks something.
    pub fn is_linear(&self, iteration: usize) -> bool {
        iteration > LOAD_STEP.late && self.contraction > LOAD_STEP.slow
    }

    /// Whether corrections shrink, but so slowly that the most of them is held back.
    pub fn is_held_back(&self, iteration: usize) -> bool {
        self.is_linear(iteration) && self.has_stalled() && self.contraction < 1.0
    }

    /// Whether the last correction is the smallest so far by far.
    pub fn is_shrinking(&self) -> bool {
        self.stalled == 0
    }

    /// Takes note of a guess that led nowhere.
    ///
    /// # Errors
    /// `failed`, if there have been too many.
    pub fn refuse(&mut self, failed: StepError) -> Result<(), StepError> {
        self.refused += 1;
        self.last = f64::INFINITY;
        if self.refused > LOAD_STEP.refusals { Err(failed) } else { Ok(()) }
    }
}
