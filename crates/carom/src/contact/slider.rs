//! A contact whose pair has a friction law.

use carom_friction::{FrictionLaw, Sliding};
use carom_mesh::Vector;

use super::control::CONTROL;
use crate::error::StepError;
use crate::model::friction_laws::MAX_FRICTION;
use crate::model::sliding::SlidingRecord;

/// A contact of a pair that has a friction law.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Slider<const D: usize> {
    /// Its place among the contacts.
    pub contact: usize,
    /// Of friction with a law for each direction the lengths of its tangents: what μ along and across are of the larger one.
    pub lengths: Option<[f64; 2]>,
    /// What it brings from the steps before,
    pub before: SlidingRecord<D>,
    /// and what it leaves.
    pub after: SlidingRecord<D>,
    /// Whether it holds up to its static coefficient, where that jumps.
    pub holds: bool,
    /// Whether that was tried after it turned back, and in vain.
    turned: bool,
    /// The last μ and what the law was above it; none in the first round.
    last: Option<[f64; 2]>,
}

impl<const D: usize> Slider<D> {
    /// Of a contact with what is known of it.
    pub fn new(contact: usize, before: SlidingRecord<D>) -> Self {
        Self { contact, lengths: None, before, after: before, holds: false, turned: false, last: None }
    }

    /// Begins to look for μ anew: what stuck holds.
    pub fn begin(&mut self, law: &dyn FrictionLaw, mu: &mut f64) {
        self.last = None;
        self.turned = false;
        if let Some(holding) = law.holding() {
            self.holds = self.before.direction == Vector::<D>::zeros();
            *mu = if self.holds { holding } else { law.coefficient(&self.at_start()) };
        }
    }

    /// How it is at the start of the step, if it does not slide.
    pub fn at_start(&self) -> Sliding {
        let SlidingRecord { distance, state, .. } = self.before;
        Sliding { distance, state, ..Sliding::default() }
    }

    /// How it is in the middle of a step in which it `slides`: friction then does the work of a law that is linear in the distance exactly.
    pub fn half_way(&self, law: &dyn FrictionLaw, slides: &Slides<D>) -> Sliding {
        let SlidingRecord { distance, state, .. } = self.before;
        let speed = slides.speed;
        Sliding {
            speed,
            distance: distance + 0.5 * slides.distance,
            pressure: slides.pressure,
            state: if slides.presses { law.evolved(state, speed, 0.5 * slides.dt) } else { state },
        }
    }

    /// The lengths that its tangents are to have where it `slides`; none where friction is the same both ways, or has constant coefficients.
    pub fn lengths_for(
        &self,
        law: &dyn FrictionLaw,
        sliding: &Sliding,
    ) -> Result<Option<[f64; 2]>, StepError> {
        let Some(coefficients) = law.by_direction(sliding) else { return Ok(None) };
        let largest = coefficients[0].max(coefficients[1]);
        let lengths = coefficients.map(|mu| mu / largest);
        match lengths.iter().position(|length| length.is_nan() || *length < CONTROL.narrowest) {
            None => Ok(Some(lengths)),
            Some(k) => Err(self.no_coefficient(coefficients[k], sliding)),
        }
    }

    fn no_coefficient(&self, coefficient: f64, at: &Sliding) -> StepError {
        StepError::FrictionLaw { coefficient, speed: at.speed, distance: at.distance }
    }

    /// Notes what a step leaves in which it `slides`.
    pub fn leave(&mut self, law: &dyn FrictionLaw, slides: &Slides<D>) {
        let SlidingRecord { distance, state, .. } = self.before;
        self.after.distance = distance + slides.distance;
        self.after.direction = if slides.slips { slides.direction } else { Vector::zeros() };
        self.after.state = if slides.presses { law.evolved(state, slides.speed, slides.dt) } else { state };
    }

    /// The next μ after one with which the contact slid as it `slides`, and how far this one was from the law.
    pub fn next(
        &mut self,
        law: &dyn FrictionLaw,
        mu: f64,
        slides: &Slides<D>,
    ) -> Result<(f64, f64), StepError> {
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
            return Err(self.no_coefficient(target, &at));
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
pub(crate) struct Slides<const D: usize> {
    /// Whether it presses,
    pub presses: bool,
    /// and whether it slips.
    pub slips: bool,
    /// Length of the step [s].
    pub dt: f64,
    /// Speed [m/s].
    pub speed: f64,
    /// Pressure [Pa].
    pub pressure: f64,
    /// Distance in the step [m].
    pub distance: f64,
    /// The way, of length 1.
    pub direction: Vector<D>,
}

/// That of a contact, given by its place.
pub(crate) fn slider_of<const D: usize>(sliders: &[Slider<D>], contact: usize) -> Option<&Slider<D>> {
    sliders.binary_search_by_key(&contact, |slider| slider.contact).ok().map(|k| &sliders[k])
}
