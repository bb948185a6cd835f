//! What drives a body in a step: prescribed motion and loads.

use carom_mesh::Vector;

use super::part::ModelBody;
use crate::body::{BodyState, Guess, Interval};
use crate::signal::Signal;

/// What drives a body in a step. Loads are empty where there is none.
#[derive(Debug, Default)]
pub(crate) struct Drive<const D: usize> {
    /// v₊ [m/s] of everything held, in the order of `Body::held`.
    pub rates: Vec<f64>,
    /// F̄ [N], the loads as the scheme weighs them; those that follow the body at the present guess.
    pub mean: Vec<Vector<D>>,
    /// F₊ [N], the loads at the end of the step.
    pub end: Vec<Vector<D>>,
    /// u between start and end, where loads that follow the body act.
    between: Vec<Vector<D>>,
}

impl<const D: usize> Drive<D> {
    /// The drive of a body.
    pub fn new(part: &ModelBody<D>) -> Self {
        let loads = if part.loads.is_empty() { 0 } else { part.body.node_count() };
        Self {
            rates: vec![0.0; part.body.held().dofs().len()],
            mean: vec![Vector::zeros(); loads],
            end: vec![Vector::zeros(); loads],
            between: vec![Vector::zeros(); loads],
        }
    }

    /// Evaluates the loads at a guess.
    pub fn load(&mut self, part: &ModelBody<D>, guess: &Guess<'_, D>) {
        self.load_at(part, guess, guess.interval.map.xi);
    }

    /// Evaluates the loads at a guess, the mean ones at `share` of the way from the start to the end of the step.
    pub fn load_at(&mut self, part: &ModelBody<D>, guess: &Guess<'_, D>, share: f64) {
        if part.loads.is_empty() {
            return;
        }
        let Self { mean, end, between, .. } = self;
        let Interval { start, end: finish, .. } = guess.interval;
        for ((x, u), d) in between.iter_mut().zip(guess.start.displacement).zip(guess.motion) {
            *x = u + d * share;
        }
        let times = [*start, *finish];
        let weighted = |s: &Signal| (1.0 - share) * s.at(times[0]).value + share * s.at(times[1]).value;
        mean.fill(Vector::zeros());
        end.fill(Vector::zeros());
        for load in &part.loads {
            load.add(&part.body, weighted, between, mean);
            load.add(&part.body, |s| s.at(times[1]).value, guess.displacement, end);
        }
    }

    /// The sum of the loads at the start of a step [N].
    pub fn load_at_start(
        &mut self,
        part: &ModelBody<D>,
        interval: &Interval,
        start: &BodyState<'_, D>,
    ) -> Vector<D> {
        self.mean.fill(Vector::zeros());
        for load in &part.loads {
            load.add(&part.body, |s| s.at(interval.start).value, start.displacement, &mut self.mean);
        }
        self.mean.iter().sum()
    }

    /// Sets the `motion` [m] of everything held, which goes on from `start`, to what is prescribed. Returns the largest of it [m], or
    /// none if a function of time is not finite.
    pub fn prescribe(
        &mut self,
        part: &ModelBody<D>,
        interval: &Interval,
        start: &BodyState<'_, D>,
        motion: &mut [Vector<D>],
    ) -> Option<f64> {
        let end = interval.end;
        let (mut largest, mut sum): (f64, f64) = (0.0, 0.0);
        for ((dof, there), rate) in part.supports.at(&part.body, end).zip(&mut self.rates) {
            let (node, component) = (dof.node as usize, dof.component as usize);
            let d = start.anchor[node][component] + there.value - start.displacement[node][component];
            motion[node][component] = d;
            *rate = if interval.is_load_step { 0.0 } else { there.rate };
            largest = largest.max(d.abs());
            sum += d + there.rate;
        }
        sum.is_finite().then_some(largest)
    }
}
