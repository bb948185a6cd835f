//! Friction laws whose coefficient depends on the motion, as fixed points around the contact problem.
//!
//! In every iteration of a step the contact problem is solved for a μ, and μ is what the law says of the motion that this gives, until
//! both agree. What Newton's iterations then see is one problem with one solution, whatever its law.

use carom_contact::Pair;
use carom_friction::{ContactProblem, SolveReport, cone};
use carom_mesh::{Matrix, Vector};

use super::active::ActiveSet;
use super::control::CONTROL;
use super::slider::{Slider, Slides};
use crate::error::StepError;
use crate::model::friction_laws::MAX_FRICTION;
use crate::model::given::Given;
use crate::model::sliding::SlidingRecord;

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
            if self.is_unbreakable(given, i) {
                continue;
            }
            let Some(law) = assembly.friction_laws.of(&pair).filter(|_| assembly.can_slide(candidate)) else {
                continue;
            };
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
            pressure: self.pressing.at(i, |j| self.acting(j)[0]) / self.weights[i],
            distance: if slips { cone::tangential_norm(&(w - offset)) } else { 0.0 },
            direction: direction.try_normalize(0.0).unwrap_or_else(Vector::zeros),
        }
    }

    /// Solves the `problem` by `solve`, again and again, until its coefficients are those that the laws say of its solution, which is left in the
    /// reactions, the coefficients in [`Self::friction`]. What of W moves nothing is in `stand_ins`: see `Delassus::stand_ins`.
    pub fn solve_with_laws(
        &mut self,
        given: &Given<'_, D>,
        offsets: &[Vector<D>],
        stand_ins: &[Matrix<D>],
        problem: &mut ContactProblem<D>,
        mut solve: impl FnMut(&ContactProblem<D>, &mut [Vector<D>]) -> SolveReport,
    ) -> Result<SolveReport, StepError> {
        let assembly = given.assembly;
        let mut sliders = std::mem::take(&mut self.sliders);
        let law = |slider: &Slider<D>, active: &Self| {
            let pair = active.candidates[slider.contact].pair as usize;
            assembly.friction_laws.of(&assembly.contact.pairs.get(pair))
        };
        self.pressing.prepare(given, &self.candidates, &self.contacts, &sliders);
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
                // What stands in for a direction that is held moves nothing.
                let w = problem.motion(i, &self.reactions) - stand_ins[i] * self.reactions[i];
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

    /// The coefficient up to which a contact holds that sticks, where that is more than what resists it once it slides, with the direction in which it
    /// slid in the step, zero if it stuck; none of others.
    pub fn holding(&self, given: &Given<'_, D>, contact: usize) -> Option<(f64, Vector<D>)> {
        let slider = self.slider_of(contact)?;
        let pair = given.assembly.contact.pairs.get(slider.before.pair as usize);
        let holding = given.assembly.friction_laws.of(&pair)?.holding()?;
        Some((holding, slider.after.direction))
    }

    /// The contact of a slider.
    pub fn slider_of(&self, contact: usize) -> Option<&Slider<D>> {
        self.sliders.binary_search_by_key(&contact, |slider| slider.contact).ok().map(|k| &self.sliders[k])
    }
}
