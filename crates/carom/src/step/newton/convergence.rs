//! When the iterations of a step have ended, are slow, or lead astray.

use super::control::CONTROL;
use crate::contact::Accuracy;
use crate::error::StepError;
use crate::model::given::Given;
use crate::scheme::StressRule;

/// How the iterations of one body go within a step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct BodyProgress {
    /// Largest component of the last correction [m].
    pub correction: f64,
    /// Its ratio to the one before; 1 while there is none.
    pub contraction: f64,
    /// Largest component of the motion that the iterations started with [m].
    predicted: f64,
    /// The larger of that and of the motion in the step so far [m].
    pub motion: f64,
}

impl BodyProgress {
    /// At the start of the iterations, with the largest component of the `predicted` motion [m].
    pub fn new(predicted: f64) -> Self {
        Self { predicted, motion: predicted, correction: f64::INFINITY, contraction: 1.0 }
    }

    /// Takes note of a new correction and of the motion that it leads to.
    pub fn note(&mut self, correction: f64, motion: f64) {
        self.contraction = if self.correction.is_finite() { correction / self.correction } else { 1.0 };
        self.correction = correction;
        self.motion = self.predicted.max(motion);
    }
}

/// The rules by which the iterations of some bodies in a step are judged.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Convergence {
    safety: f64,
    /// Whether bodies become others in the step.
    is_changing: bool,
    /// Whether its first iteration lacks the blend, and leaves momenta open: it ends nothing but what does not move at all.
    is_blended: bool,
    max_iterations: usize,
    /// Relative to the motion in the step.
    tolerance: f64,
    /// Smaller corrections say nothing [m].
    round_off: f64,
    /// What the tolerance of the contact problem leaves of motions [m]: where bodies rest in contact that is more than a part of their motion,
    /// and no iteration makes it smaller.
    pub left_by_contacts: f64,
    /// How far the first iteration went, `snap` times [m].
    reach: f64,
    /// How many times farther a correction may go: as far as in the whole step that this one is a part of, where nodes at the boundary have no mass. These
    /// are in equilibrium, and may snap from one to the next however short the step is.
    snap: f64,
    /// The last correction that was at most half of the one noted before [m], and the iterations since.
    least: f64,
    stalled: usize,
}

impl Convergence {
    /// Of some `bodies`.
    pub fn new<const D: usize>(bodies: &[usize], given: &Given<'_, D>) -> Self {
        let Given { assembly, method, state, interval } = *given;
        let map = &interval.map;
        let is_changing = bodies.iter().any(|&i| !state.history[i].is_empty());
        // What the blend adds to reactions on bodies with mass is that of the last guess: the end is slower than the beginning.
        let lags = interval.is_blended && assembly.is_mixed();
        let safety = match map.stress {
            StressRule::Conserving if !interval.is_blended => CONTROL.safety,
            // What iterations leave of the energy blended steps make good.
            StressRule::Conserving | StressRule::Weighted => CONTROL.less_safety,
        };
        let length = interval.end - interval.start;
        Self {
            safety: if lags { f64::INFINITY } else { safety },
            is_changing,
            is_blended: interval.is_blended,
            max_iterations: method.newton.max_iterations,
            tolerance: method.newton.tolerance,
            round_off: assembly.round_off(),
            left_by_contacts: 0.0,
            reach: 0.0,
            snap: if interval.is_blended && length > 0.0 { interval.whole / length } else { 1.0 },
            least: f64::INFINITY,
            stalled: 0,
        }
    }

    /// Whether the `bodies` have converged: relative to the largest motion among them, down to round-off.
    ///
    /// # Errors
    /// If the iterations lead astray or must not go on.
    pub fn settle(
        &mut self,
        iteration: usize,
        bodies: &[usize],
        all: &[BodyProgress],
    ) -> Result<bool, StepError> {
        let progress = || bodies.iter().map(|&i| &all[i]);
        let motion = progress().map(|p| p.motion).fold(0.0, f64::max);
        let correction = progress().map(|p| p.correction).fold(0.0, f64::max);
        self.check_reach(iteration, motion, correction)?;
        let is_whole = !(self.is_blended && iteration == 1) || correction <= self.round_off;
        if is_whole && progress().all(|p| self.has_converged(p, motion)) {
            return Ok(true);
        }
        let hopeless = self.stalls(correction);
        if hopeless && self.is_unavoidable(correction) {
            return Ok(true);
        }
        if iteration < self.max_iterations && !hopeless {
            return Ok(false);
        }
        let wanted = self.wanted(motion);
        Err(StepError::Newton { iterations: iteration, correction, wanted })
    }

    /// The largest component of the last corrections of the `bodies` [m].
    pub fn largest_correction(&self, bodies: &[usize], progress: &[BodyProgress]) -> f64 {
        bodies.iter().map(|&i| progress[i].correction).fold(0.0, f64::max)
    }

    /// Whether corrections shrink no faster than they would by a K̄ that lacks something.
    pub fn is_linear(&self, bodies: &[usize], progress: &[BodyProgress]) -> bool {
        bodies.iter().map(|&i| progress[i].contraction).fold(0.0, f64::max) > CONTROL.slow_contraction
    }

    /// Takes note that the iterations go on from an earlier guess.
    pub fn has_returned(&mut self) {
        self.stalled = 0;
    }

    /// How wrong the motion of so many `contacts` may be after the next iteration, which the last one has `nearly_settled` or not.
    pub fn accuracy(
        &self,
        contacts: usize,
        nearly_settled: bool,
        bodies: &[usize],
        progress: &[BodyProgress],
    ) -> Accuracy {
        let largest =
            |of: fn(&BodyProgress) -> f64| bodies.iter().map(|&i| of(&progress[i])).fold(0.0, f64::max);
        let motion = largest(|p| p.motion);
        let expected = largest(|p| p.correction * p.contraction);
        if nearly_settled
            || contacts < CONTROL.many_contacts
            || expected <= CONTROL.near * self.wanted(motion)
        {
            return Accuracy::Last(CONTROL.part_of_contacts * self.exact(motion));
        }
        let known = largest(|p| p.contraction) < 1.0;
        Accuracy::Passing(if known {
            CONTROL.loose * expected
        } else {
            CONTROL.loose_at_first * largest(|p| p.correction).min(motion)
        })
    }

    /// Takes note of a correction [m]; whether it has been long since one was much smaller than those before.
    fn stalls(&mut self, correction: f64) -> bool {
        if correction <= 0.5 * self.least {
            (self.least, self.stalled) = (correction, 0);
        } else {
            self.stalled += 1;
        }
        self.stalled >= CONTROL.stalled
    }

    /// Whether a correction [m] where iterations stall is due to round-off.
    fn is_unavoidable(&self, correction: f64) -> bool {
        correction <= CONTROL.unavoidable * self.round_off
    }

    /// A correction this small, or one after which the next will surely be.
    fn has_converged(&self, p: &BodyProgress, motion: f64) -> bool {
        let left = (self.safety * p.contraction.max(CONTROL.least_contraction)).min(1.0);
        p.correction * left <= self.wanted(motion)
    }

    /// The correction that may be left where the largest motion in the step is `motion` [m].
    fn wanted(&self, motion: f64) -> f64 {
        self.exact(motion).max(self.left_by_contacts)
    }

    /// The same if contacts leave nothing.
    fn exact(&self, motion: f64) -> f64 {
        (self.tolerance * motion).max(self.round_off)
    }

    /// Refuses iterations that lead away from where they set out.
    fn check_reach(&mut self, iteration: usize, motion: f64, correction: f64) -> Result<(), StepError> {
        if iteration == 1 {
            self.reach = motion.max(correction).max(self.round_off) * self.snap;
        }
        if correction > CONTROL.astray * self.reach {
            return Err(StepError::Astray { iterations: iteration, correction, reach: self.reach });
        }
        Ok(())
    }

    /// Whether one of the `bodies` converges so slowly that they need new factors, `since` so many iterations with those they have.
    ///
    /// Where bodies become others, every iteration may make one. Elsewhere a new one has the patience that the first had. Acceleration
    /// begins anew with it, and without acceleration the iterations of some steps of `massless` contact only come near their solution.
    pub fn is_slow(
        &self,
        iteration: usize,
        since: usize,
        bodies: &[usize],
        progress: &[BodyProgress],
    ) -> bool {
        let is_patient =
            if self.is_changing { iteration < CONTROL.changed_patience } else { since < CONTROL.patience };
        !is_patient && self.is_linear(bodies, progress)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const DYNAMIC: Convergence = Convergence {
        safety: CONTROL.safety,
        is_changing: false,
        is_blended: false,
        max_iterations: 100,
        tolerance: 1e-10,
        round_off: 0.0,
        left_by_contacts: 0.0,
        reach: 0.0,
        snap: 1.0,
        least: f64::INFINITY,
        stalled: 0,
    };

    /// How many corrections it takes to see that they lead nowhere; none if they do.
    fn hopeless_after(corrections: impl IntoIterator<Item = f64>) -> Option<usize> {
        let mut convergence = DYNAMIC;
        corrections.into_iter().position(|c| convergence.stalls(c)).map(|index| index + 1)
    }

    #[test]
    fn iterations_that_wander_are_hopeless_and_those_that_are_slow_are_not() {
        let wander = (0..50).map(|k| 1.0 + 0.4 * f64::from(k).sin());
        assert_eq!(hopeless_after(wander), Some(CONTROL.stalled + 1));
        assert_eq!(hopeless_after((0..90).map(|k| 0.9_f64.powi(k))), None);
        let late = (0..40).map(|k| if k < 14 { 1.0 } else { 0.1_f64.powi(k - 13) });
        assert_eq!(hopeless_after(late), None);
    }

    /// Symptom guarded against: a clamped block on a shaking floor failed with corrections of 4e-15 m where 3e-15 m were wanted.
    #[test]
    fn where_round_off_stalls_iterations_they_have_converged() {
        let convergence = Convergence { round_off: 1e-15, ..DYNAMIC };
        let end = |noise: f64| {
            let mut convergence = convergence;
            let mut corrections =
                (0..50).map(|k| 0.1_f64.powi(k).max(noise * (1.0 + 0.4 * f64::from(k).sin())));
            let last = corrections.find(|&c| convergence.stalls(c)).expect("stalls");
            convergence.is_unavoidable(last)
        };
        assert!(end(3e-15));
        assert!(!end(3e-13));
    }

    /// The iterations of 30 slow ones after which a factor is made.
    fn renewals(convergence: Convergence) -> Vec<usize> {
        let mut slow = BodyProgress::new(1.0);
        (0..2).for_each(|_| slow.note(1.0, 1.0));
        let mut renewed = Vec::new();
        for iteration in 1..=30 {
            if convergence.is_slow(iteration, iteration - renewed.last().unwrap_or(&0), &[0], &[slow]) {
                renewed.push(iteration);
            }
        }
        renewed
    }

    /// Symptom guarded against: a factor renewed in every iteration forgot each time what acceleration had learnt. Steps of massless
    /// contact ended with corrections a hundred times as large as wanted.
    #[test]
    fn a_renewed_factor_is_given_time_where_bodies_stay_what_they_are() {
        assert_eq!(renewals(DYNAMIC), [12, 24]);
        assert!(renewals(Convergence { is_changing: true, ..DYNAMIC }).into_iter().eq(3..=30));
    }

    /// Symptom guarded against: boundaries without mass snapped by 0.1 mm, and every step that led there was refused, the shorter the surer.
    #[test]
    fn parts_of_a_step_may_snap_as_far_as_the_whole_one() {
        let second = |snap: f64, correction: f64| {
            let mut convergence = Convergence { snap, ..DYNAMIC };
            convergence.check_reach(1, 1.0, 0.5).expect("the first correction is as large as it is");
            convergence.check_reach(2, 1.0, correction)
        };
        assert!(second(1.0, 0.9 * CONTROL.astray).is_ok());
        assert!(second(1.0, 1.1 * CONTROL.astray).is_err());
        assert!(second(256.0, 250.0 * CONTROL.astray).is_ok());
        assert!(second(256.0, 260.0 * CONTROL.astray).is_err());
    }

    /// Loosely where much is still to come, to the end where this may be the end, and where it costs little.
    #[test]
    fn contacts_are_solved_as_well_as_it_takes() {
        let convergence = Convergence { round_off: 1e-15, ..DYNAMIC };
        let error = |contacts, corrections: &[f64]| {
            let mut progress = BodyProgress::new(1.0);
            corrections.iter().for_each(|&c| progress.note(c, 1.0));
            convergence.accuracy(contacts, false, &[0], &[progress])
        };
        let many = CONTROL.many_contacts;
        assert_eq!(error(many, &[]), Accuracy::Passing(CONTROL.loose_at_first));
        assert_eq!(error(many, &[0.5, 0.125]), Accuracy::Passing(CONTROL.loose * 0.125 / 4.0));
        assert_eq!(error(many, &[1e-6, 1e-8]), Accuracy::Last(CONTROL.part_of_contacts * 1e-10));
        assert_eq!(error(many - 1, &[0.5, 0.1]), Accuracy::Last(CONTROL.part_of_contacts * 1e-10));
    }
}
