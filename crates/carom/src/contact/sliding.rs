//! Friction laws whose coefficient depends on the motion, as fixed points around the contact problem.
//!
//! In every iteration of a step the contact problem is solved for a μ, and μ is what the law says of the motion that this gives, until
//! both agree. What Newton's iterations then see is one problem with one solution, whatever its law.

use carom_contact::Pair;
use carom_friction::{ContactProblem, SolveReport, cone};
use carom_mesh::{Matrix, Vector};

use super::active::ActiveSet;
use super::control::CONTROL;
use super::slider::{Slider, Slides, slider_of};
use crate::error::StepError;
use crate::model::friction_laws::MAX_FRICTION;
use crate::model::given::Given;
use crate::model::sliding::SlidingRecord;

/// A contact problem, and what goes with it in the frames of its contacts.
pub(crate) struct Posed<'a, const D: usize> {
    pub problem: &'a mut ContactProblem<D>,
    /// The reactions that bodies know of.
    pub guess: &'a mut [Vector<D>],
    pub offsets: &'a mut [Vector<D>],
    /// What of W moves nothing: see `Delassus::stand_ins`.
    pub stand_ins: &'a mut [Matrix<D>],
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
            if self.is_bond(i) {
                continue;
            }
            let Some(law) = assembly.friction_laws.of(&pair).filter(|_| assembly.can_slide(candidate)) else {
                continue;
            };
            let found = state.sliding.binary_search_by_key(&candidate.key(), SlidingRecord::key);
            let new = || SlidingRecord::new(candidate.key(), law.initial_state());
            let known = found.map_or_else(|_| new(), |k| state.sliding[k]);
            let mut slider = Slider::new(i, known);
            slider.lengths = slider.lengths_for(law, &slider.at_start()).ok().flatten();
            self.friction[i] = law.coefficient(&slider.at_start()).clamp(0.0, MAX_FRICTION);
            self.sliders.push(slider);
        }
    }

    /// Makes what tells the pressure at `sliders`.
    pub(super) fn prepare_pressing(&mut self, given: &Given<'_, D>, sliders: &[Slider<D>]) {
        self.pressing.prepare(given, &self.candidates, &self.contacts, sliders);
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
        // Frames of orthotropic friction are stretched.
        let is_stretched = assembly.orthotropies.of(self.candidates[i].pair, &assembly.contact).is_some();
        let along = |x: &Vector<D>| {
            if is_stretched { self.contacts[i].distance(x) } else { cone::tangential_norm(x) }
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
            speed: if presses { along(w) * per_motion } else { 0.0 },
            pressure: self.pressing.at(i, |j| self.acting(j)[0]) / self.weights[i],
            distance: if slips { along(&(w - offset)) } else { 0.0 },
            direction: direction.try_normalize(0.0).unwrap_or_else(Vector::zeros),
        }
    }

    /// Solves the `problem` by `solve`, again and again, until its coefficients are those that the laws say of its solution, which is left in the
    /// reactions, the coefficients in [`Self::friction`].
    pub fn solve_with_laws(
        &mut self,
        given: &Given<'_, D>,
        posed: &mut Posed<'_, D>,
        mut solve: impl FnMut(&ContactProblem<D>, &mut [Vector<D>]) -> SolveReport,
    ) -> Result<SolveReport, StepError> {
        let assembly = given.assembly;
        let mut sliders = std::mem::take(&mut self.sliders);
        let law = |slider: &Slider<D>, active: &Self| {
            let pair = active.candidates[slider.contact].pair as usize;
            assembly.friction_laws.of(&assembly.contact.pairs.get(pair))
        };
        self.prepare_pressing(given, &sliders);
        for slider in &mut sliders {
            if let Some(law) = law(slider, self) {
                slider.begin(law, &mut self.friction[slider.contact]);
            }
        }
        let mut made = Ok(());
        let mut report;
        let mut rounds = 0;
        let mut next_lengths = Vec::new();
        loop {
            posed.problem.mu.clone_from(&self.friction);
            report = solve(posed.problem, &mut self.reactions);
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
                let Posed { problem, offsets, stand_ins, .. } = &*posed;
                let w = problem.motion(i, &self.reactions) - stand_ins[i] * self.reactions[i];
                let slides =
                    self.slides(given, i, [&self.reactions[i], &w, &offsets[i]], problem.step_length(i));
                slider.leave(law, &slides);
                let lengths = match slider.lengths_for(law, &slider.half_way(law, &slides)) {
                    Ok(lengths) => lengths,
                    Err(error) => {
                        made = Err(error);
                        continue;
                    }
                };
                if let (Some(before), Some(lengths)) = (slider.lengths, lengths) {
                    let by = [lengths[0] / before[0], lengths[1] / before[1]];
                    let off = (by[0] - 1.0).abs().max((by[1] - 1.0).abs());
                    is_settled &= off <= CONTROL.law_settled;
                    is_near &= off <= CONTROL.law_near;
                    self.unsettled = self.unsettled.max(off);
                    if off > CONTROL.law_settled {
                        next_lengths.push((i, by));
                        slider.lengths = Some(lengths);
                    }
                }
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
            next_lengths.drain(..).for_each(|(i, by)| self.stretch(i, by, posed));
        }
        self.next_friction.clear();
        self.sliders = sliders;
        made.map(|()| report)
    }

    /// Makes the tangents of contact `i` so many times as long, in its problem too.
    fn stretch(&mut self, i: usize, by: [f64; 2], posed: &mut Posed<'_, D>) {
        let factors = Vector::<D>::from_fn(|k, _| if k == 0 { 1.0 } else { by[k - 1] });
        let Posed { problem, guess, offsets, stand_ins } = posed;
        problem.w.scale(i, &factors);
        problem.q[i].component_mul_assign(&factors);
        offsets[i].component_mul_assign(&factors);
        stand_ins[i] = Matrix::from_diagonal(&factors) * stand_ins[i] * Matrix::from_diagonal(&factors);
        for r in [&mut self.reactions[i], &mut guess[i]] {
            r.component_div_assign(&factors);
        }
        self.contacts[i].stretch_tangents(by);
        self.frames[i] = self.contacts[i].frame;
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
        slides.distance = if is_at_rest { 0.0 } else { self.contacts[i].distance(&(w - offset)) };
        let at = slider.half_way(law, &slides);
        match (law.by_direction(&at), slider.lengths) {
            (Some(wanted), Some(lengths)) => {
                let both = wanted.iter().zip(lengths);
                both.map(|(mu, length)| (mu - length * self.friction[i]).abs()).fold(0.0, f64::max)
            }
            _ => (law.coefficient(&at) - self.friction[i]).abs(),
        }
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
        slider_of(&self.sliders, contact)
    }
}
