use carom_contact::{Candidate, Contact, Pair, Site, Target};
use carom_mesh::Vector;

use crate::StepError;
use crate::body::{BodyState, Guess, Interval};
use crate::model::assembly::Assembly;
use crate::model::condition::ContactCondition;
use crate::model::method::Method;
use crate::model::state::State;

/// What is given in a step: who takes part, by what method, from where and for how long.
#[derive(Clone, Copy)]
pub(crate) struct Given<'a, const D: usize> {
    pub assembly: &'a Assembly<D>,
    pub method: &'a Method<D>,
    /// The state that the step starts from.
    pub state: &'a State<D>,
    pub interval: &'a Interval,
}

impl<'a, const D: usize> Given<'a, D> {
    /// The part of body `index` in the state.
    pub fn start(&self, index: usize) -> BodyState<'a, D> {
        self.state.body(index, self.assembly.nodes(index))
    }

    /// What is guessed of body `index`, where the model moves by `motion` [m] to `displacement` [m].
    pub fn guess<'g>(
        &'g self,
        index: usize,
        motion: &'g [Vector<D>],
        displacement: &'g [Vector<D>],
    ) -> Guess<'g, D> {
        let nodes = self.assembly.nodes(index);
        Guess {
            interval: self.interval,
            start: self.start(index),
            motion: &motion[nodes.clone()],
            displacement: &displacement[nodes],
        }
    }

    /// Where a node is at the start of the step [m].
    #[inline]
    pub fn position(&self, node: u32) -> Vector<D> {
        self.assembly.reference[node as usize] + self.state.displacement[node as usize]
    }

    /// The interference of a contact, given by pair and site, at both ends of the step [m].
    pub fn interference(&self, contact: (u32, Site)) -> [f64; 2] {
        self.assembly.interference(contact.0).ends(contact, self.interval)
    }

    /// What holds a contact together in the step [N] that is like this at its start, where it `is_closed` or not; none if nothing does.
    pub fn adhesion(&self, candidate: &Candidate, at_start: &Contact<D>, is_closed: bool) -> Option<f64> {
        let Self { assembly, state, .. } = *self;
        if assembly.cohesions.are_none() {
            return None;
        }
        let known = state.reaction(candidate.key())?;
        let cohesion = assembly.cohesions.of(&assembly.contact.pairs.get(candidate.pair as usize))?;
        if known.adhesion.is_none() && !(cohesion.lasting && is_closed) {
            return None;
        }
        let adhesion = assembly.adhesion(candidate.key(), at_start, &|n| self.position(n))?;
        // What nothing breaks has held so much before.
        let before = known.adhesion.filter(|_| assembly.is_unbreakable(candidate.pair));
        Some(adhesion.max(before.unwrap_or(0.0)))
    }

    /// The condition of a pair of the contact model: that of the method, unless it wants nodes without mass and neither side has such. Then it is
    /// the motion that is ruled.
    pub fn condition_of(&self, pair: u32) -> ContactCondition {
        let condition = self.method.condition;
        if !(condition.is_massless() && self.assembly.is_mixed()) {
            return condition;
        }
        let Pair { source, target, .. } = self.assembly.contact.pairs.get(pair as usize);
        let is_massless = |body: usize| self.assembly.is_massless(body);
        let is_met_by_one = matches!(target, Target::Surface(target) if is_massless(target));
        if is_massless(source) || is_met_by_one { condition } else { ContactCondition::Midpoint }
    }

    /// Sets the motion [m] of obstacles, whose places come after the nodes of bodies; returns the largest that is prescribed [m].
    ///
    /// # Errors
    /// If a function of time is not finite.
    pub fn move_obstacles(&self, motion: &mut [Vector<D>]) -> Result<f64, StepError> {
        let end = self.interval.end;
        let dt = end - self.interval.start;
        let obstacles = self.assembly.node_count()..;
        let (mut largest, mut sum): (f64, f64) = (0.0, 0.0);
        let starts = &self.state.displacement[obstacles.clone()];
        for ((d, u), moved) in motion[obstacles].iter_mut().zip(starts).zip(&self.assembly.obstacle_motions) {
            *d = moved.increment(u, end, dt);
            if moved.is_prescribed() {
                largest = largest.max(d.norm());
            }
            sum += d.sum();
        }
        if sum.is_finite() { Ok(largest) } else { Err(StepError::NotFinite("prescribed motion")) }
    }
}
