//! Friction laws whose coefficient depends on the motion, as fixed points around the contact problem.
//!
//! In every iteration of a step the contact problem is solved for a μ, and μ is what the law says of the motion that this gives, until
//! both agree. What Newton's iterations then see is one problem with one solution, whatever its law.

use carom_contact::Pair;
use carom_friction::{ContactProblem, FrictionLaw, Sliding, SolveReport, cone};
use carom_mesh::Vector;

use super::active::ActiveSet;
use super::control::CONTROL;
use crate::build::MAX_FRICTION;
use crate::error::StepError;
use crate::model::given::Given;
use crate::model::sliding::SlidingRecord;

/// A contact of a pair that has a friction law.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Slider<const D: usize> {
    /// Its place among the contacts.
    contact: usize,
    /// What it brings from the steps before,
    before: SlidingRecord<D>,
    /// and what it leaves.
    pub after: SlidingRecord<D>,
    /// Whether it holds up to its static coefficient, where that jumps.
    holds: bool,
    /// Whether that was tried after it turned back, and in vain.
    turned: bool,
    /// The last μ and what the law was above it; none in the first round.
    last: Option<[f64; 2]>,
}

impl<const D: usize> Slider<D> {
    /// Of a contact with what is known of it.
    pub fn new(contact: usize, before: SlidingRecord<D>) -> Self {
        Self { contact, before, after: before, holds: false, turned: false, last: None }
    }

    /// Begins to look for μ anew: what stuck holds.
    fn begin(&mut self, law: &dyn FrictionLaw, mu: &mut f64) {
        self.last = None;
        self.turned = false;
        if let Some(holding) = law.holding() {
            self.holds = self.before.direction == Vector::<D>::zeros();
            *mu = if self.holds { holding } else { law.coefficient(&self.at_start()) };
        }
    }

    /// How it is at the start of the step, if it does not slide.
    fn at_start(&self) -> Sliding {
        let SlidingRecord { distance, state, .. } = self.before;
        Sliding { distance, state, ..Sliding::default() }
    }

    /// How it is in the middle of a step in which it `slides`: friction then does the work of a law that is linear in the distance exactly.
    fn half_way(&self, law: &dyn FrictionLaw, slides: &Slides<D>) -> Sliding {
        let SlidingRecord { distance, state, .. } = self.before;
        let speed = slides.speed;
        Sliding {
            speed,
            distance: distance + 0.5 * slides.distance,
            state: if slides.presses { law.evolved(state, speed, 0.5 * slides.dt) } else { state },
        }
    }

    /// Notes what a step leaves in which it `slides`.
    fn leave(&mut self, law: &dyn FrictionLaw, slides: &Slides<D>) {
        let SlidingRecord { distance, state, .. } = self.before;
        self.after.distance = distance + slides.distance;
        self.after.direction = if slides.slips { slides.direction } else { Vector::zeros() };
        self.after.state = if slides.presses { law.evolved(state, slides.speed, slides.dt) } else { state };
    }

    /// The next μ after one with which the contact slid as it `slides`, and how far this one was from the law.
    fn next(&mut self, law: &dyn FrictionLaw, mu: f64, slides: &Slides<D>) -> Result<(f64, f64), StepError> {
        if let Some(holding) = law.holding() {
            if self.holds {
                if !slides.slips {
                    return Ok((mu, 0.0));
                }
                (self.holds, self.turned) = (false, true);
            } else if slides.slips && !self.turned && slides.direction.dot(&self.before.direction) < 0.0 {
                // It came to rest on its way through the step, and may hold there.
                self.holds = true;
                return Ok((holding, f64::INFINITY));
            }
        }
        let at = self.half_way(law, slides);
        let target = law.coefficient(&at);
        if !(0.0..=MAX_FRICTION).contains(&target) {
            return Err(StepError::FrictionLaw {
                coefficient: target,
                speed: at.speed,
                distance: at.distance,
            });
        }
        let above = target - mu;
        let secant = self.last.and_then(|[mu_before, above_before]| {
            let step = -above * (mu - mu_before) / (above - above_before);
            (step * above > 0.0 && step.abs() <= CONTROL.law_stride * above.abs()).then_some(mu + step)
        });
        self.last = Some([mu, above]);
        Ok((secant.unwrap_or(target).max(0.0), above.abs()))
    }
}

/// How a contact slides in a step.
#[derive(Debug, Clone, Copy)]
pub(super) struct Slides<const D: usize> {
    /// Whether it presses,
    pub presses: bool,
    /// and whether it slips.
    pub slips: bool,
    /// Length of the step [s].
    pub dt: f64,
    /// Speed [m/s].
    pub speed: f64,
    /// Distance in the step [m].
    pub distance: f64,
    /// The way, of length 1.
    pub direction: Vector<D>,
}

impl<const D: usize> ActiveSet<D> {
    /// Recalls what is known of the contacts whose pair has a friction law, and the coefficients with which they start.
    pub fn recall_sliding(&mut self, given: &Given<'_, D>) {
        self.sliders.clear();
        let Given { assembly, state, .. } = *given;
        if assembly.friction_laws.is_empty() {
            return;
        }
        for (i, candidate) in self.candidates.iter().enumerate() {
            let pair = assembly.contact.pairs.get(candidate.pair as usize);
            let Some(law) = assembly.friction_laws.of(&pair) else { continue };
            let found = state.sliding.binary_search_by_key(&candidate.key(), SlidingRecord::key);
            let new = || SlidingRecord::new(candidate.key(), law.initial_state());
            let known = found.map_or_else(|_| new(), |k| state.sliding[k]);
            let slider = Slider::new(i, known);
            self.friction[i] = law.coefficient(&slider.at_start()).clamp(0.0, MAX_FRICTION);
            self.sliders.push(slider);
        }
    }

    /// How contact `i` slides that presses with `r` and moves by `w` relative to its target, which lacks `offset` of the variable of
    /// friction. `step_length` makes a force of a motion [N/m].
    fn slides(
        &self,
        given: &Given<'_, D>,
        i: usize,
        [r, w, offset]: [&Vector<D>; 3],
        step_length: f64,
    ) -> Slides<D> {
        let Given { assembly, interval, .. } = *given;
        let pair: Pair = assembly.contact.pairs.get(self.candidates[i].pair as usize);
        // Of impacts of rigid bodies friction acts against the velocity at the end.
        let per_motion = match assembly.restitutions.of(&pair) {
            Some(_) => interval.map.velocity_of_motion,
            None => 1.0 / interval.map.dt,
        };
        let across = |x: &Vector<D>| Vector::<D>::from_fn(|k, _| if k == 0 { 0.0 } else { x[k] });
        let tried = across(r) - across(w) * step_length;
        let limit = self.friction[i] * r[0];
        let presses = r[0] > 0.0;
        let slips = presses && tried.norm() > limit * (1.0 + CONTROL.slips);
        let direction = self.contacts[i].frame.tr_mul(&across(w));
        Slides {
            presses,
            slips,
            dt: interval.map.dt,
            speed: if presses { cone::tangential_norm(w) * per_motion } else { 0.0 },
            distance: if slips { cone::tangential_norm(&(w - offset)) } else { 0.0 },
            direction: direction.try_normalize(0.0).unwrap_or_else(Vector::zeros),
        }
    }

    /// Solves the `problem` by `solve`, again and again, until its coefficients are those that the laws say of its solution, which is left in the
    /// reactions, the coefficients in [`Self::friction`]. `solve` returns whether it did.
    pub fn solve_with_laws(
        &mut self,
        given: &Given<'_, D>,
        offsets: &[Vector<D>],
        problem: &mut ContactProblem<D>,
        mut solve: impl FnMut(&ContactProblem<D>, &mut [Vector<D>]) -> SolveReport,
    ) -> Result<SolveReport, StepError> {
        let assembly = given.assembly;
        let mut sliders = std::mem::take(&mut self.sliders);
        let law = |slider: &Slider<D>, active: &Self| {
            let pair = active.candidates[slider.contact].pair as usize;
            assembly.friction_laws.of(&assembly.contact.pairs.get(pair))
        };
        for slider in &mut sliders {
            if let Some(law) = law(slider, self) {
                slider.begin(law, &mut self.friction[slider.contact]);
            }
        }
        let mut made = Ok(());
        let mut report;
        let mut rounds = 0;
        loop {
            problem.mu.clone_from(&self.friction);
            report = solve(problem, &mut self.reactions);
            if !report.is_solved() {
                break;
            }
            rounds += 1;
            let (mut is_settled, mut is_near) = (true, true);
            self.unsettled = 0.0;
            for slider in &mut sliders {
                let i = slider.contact;
                let Some(law) = law(slider, self) else { continue };
                let w = problem.motion(i, &self.reactions);
                let slides =
                    self.slides(given, i, [&self.reactions[i], &w, &offsets[i]], problem.step_length(i));
                slider.leave(law, &slides);
                let mu = self.friction[i];
                match slider.next(law, mu, &slides) {
                    Ok((next, off)) => {
                        let size = mu.max(next);
                        is_settled &= off <= CONTROL.law_settled * size;
                        is_near &= off <= CONTROL.law_near * size;
                        self.unsettled = self.unsettled.max(off);
                        if off > CONTROL.law_settled * size {
                            self.next_friction.push((i, next));
                        }
                    }
                    Err(error) => made = Err(error),
                }
            }
            if made.is_err() || is_settled || (is_near && rounds >= CONTROL.law_rounds) {
                self.unsettled = 0.0;
                break;
            }
            if rounds == 2 * CONTROL.law_rounds {
                break;
            }
            self.next_friction.drain(..).for_each(|(i, next)| self.friction[i] = next);
        }
        self.next_friction.clear();
        self.sliders = sliders;
        made.map(|()| report)
    }

    /// How far the coefficient of contact `slider` is from what its law says of the motion `w` [m] at the end of a step.
    pub fn off_law(
        &self,
        given: &Given<'_, D>,
        slider: &Slider<D>,
        w: &Vector<D>,
        offset: &Vector<D>,
    ) -> f64 {
        let i = slider.contact;
        let pair = given.assembly.contact.pairs.get(self.candidates[i].pair as usize);
        let Some(law) = given.assembly.friction_laws.of(&pair) else { return 0.0 };
        if slider.holds {
            return 0.0;
        }
        let mut slides = self.slides(given, i, [&self.reactions[i], w, offset], 0.0);
        let is_at_rest = slider.after.direction == Vector::<D>::zeros();
        slides.distance = if is_at_rest { 0.0 } else { cone::tangential_norm(&(w - offset)) };
        (law.coefficient(&slider.half_way(law, &slides)) - self.friction[i]).abs()
    }

    /// The contact of a slider.
    pub fn slider_of(&self, contact: usize) -> Option<&Slider<D>> {
        self.sliders.binary_search_by_key(&contact, |slider| slider.contact).ok().map(|k| &self.sliders[k])
    }
}
