//! Which contacts take part in a step, and the reactions known of them.

use carom_contact::{Candidate, Contact, Mortar, Pair, Search, Site, Target};
use carom_mesh::{Matrix, Vector};

use super::control::CONTROL;
use super::pressing::Pressing;
use super::slider::{Slider, slider_of};
use crate::body::Body;
use crate::model::assembly::Assembly;
use crate::model::at_rest::AtRest;
use crate::model::cohesion::OF_BONDS;
use crate::model::condition::{ContactCondition, Opening, impact_offset};
use crate::model::given::Given;
use crate::model::state::{Reaction, State};

/// The contacts that take part in a step, in the order of their candidates.
#[derive(Debug, Default)]
pub(crate) struct ActiveSet<const D: usize> {
    pub candidates: Vec<Candidate>,
    pub mortar: Mortar<D>,
    pub contacts: Vec<Contact<D>>,
    /// What rules every contact, and how much of its reaction the reduced problem has: see `ContactCondition::reaction_weight`.
    pub conditions: Vec<ContactCondition>,
    pub weights: Vec<f64>,
    /// The frame that every contact had when it was last evaluated, in this step or as a reaction of the last one; zeros where there is none.
    pub(super) frames: Vec<Matrix<D>>,
    pub friction: Vec<f64>,
    /// The contacts of pairs with a friction law, how far their coefficients are from it where none was found that is, and the coefficients to
    /// be tried next.
    pub sliders: Vec<Slider<D>>,
    pub unsettled: f64,
    pub(super) pressing: Pressing,
    pub(super) next_friction: Vec<(usize, f64)>,
    /// The part of its gap [m] at the start that a contact may close or keep: see `ContactCondition::start_gap`.
    pub start_gaps: Vec<f64>,
    /// The interference [m] of every contact at the start and the end of the step.
    pub interferences: Vec<[f64; 2]>,
    /// What holds every contact together [N] beside its reaction; none where nothing does.
    pub adhesions: Vec<Option<f64>>,
    /// Those that nothing breaks, as they were made, with their places; and by how much more some have to hold [N].
    pub(super) bonds: Vec<(usize, Contact<D>)>,
    pub(super) more: Vec<(usize, f64)>,
    /// Reactions [N] that the step starts with, in the frame of the last step.
    pub start_forces: Vec<Vector<D>>,
    /// The velocities [m/s] at which contacts of rigid pairs meet, in their frames; zeros of others: see [`Self::meet`].
    meeting: Vec<Vector<D>>,
    /// The contacts as they were evaluated before, and those that stand at a kink: see [`Self::evaluate_late`].
    before: Vec<Contact<D>>,
    pub at_kink: Vec<bool>,
    /// Reactions as the reduced problem has them, in their cones: see `ContactCondition::reaction_weight`, and [`Self::acting`].
    pub reactions: Vec<Vector<D>>,
    /// Reactions of the state whose contacts have no part in the step.
    pub lost: Vec<usize>,
    /// Whether contacts or springs act on a body.
    pub touched: Vec<bool>,
}

impl<const D: usize> ActiveSet<D> {
    /// Of so many bodies.
    pub fn new(bodies: usize) -> Self {
        Self { touched: vec![false; bodies], ..Self::default() }
    }

    /// Keeps the candidates that take part in the step and recalls their last reactions.
    ///
    /// A node that is found deeper inside its target than its velocity explains has not just got there. It slid past an edge that no node
    /// of the other side saw. It is kept from going deeper, until the bodies part: to push it out at once, the faster the shorter the step,
    /// would create energy. In a static analysis it is pushed out: there bodies may be meant to be pressed into one another. So is in its first
    /// step whatever is inside: nothing has come there.
    ///
    /// Those that are `needed`, ascending, take part although they are open: the last attempt at the step let them arrive. Bodies become no
    /// faster than by `fall` [m/s] in free flight.
    pub fn select(
        &mut self,
        given: &Given<'_, D>,
        (search, needed): (&Search<D>, &[(u32, Site)]),
        at_rest: &AtRest,
        fall: f64,
    ) {
        let Given { assembly, method, state, interval } = *given;
        let (contact, map) = (&assembly.contact, &interval.map);
        let start = |n: u32| given.position(n);
        self.start_gaps.clear();
        self.interferences.clear();
        self.adhesions.clear();
        contact.evaluate_all(&self.candidates, &start, &mut self.mortar, &mut self.contacts);
        let round_off = assembly.round_off();
        let inside = |c: &Candidate| CONTROL.inside * assembly.pair_size(&contact.pairs.get(c.pair as usize));
        let is_stuck = |c: &Candidate, at_start: &Contact<D>, gap: f64| {
            let inside = inside(c);
            let explained = inside + map.dt * at_start.relative(|n| state.velocity[n]).norm();
            gap < -explained || state.reaction(c.key()).is_some_and(|r| r.contact.gap < -inside)
        };
        // Where contacts are chosen at the start, whether one at rest goes on must not hang on the sign of round-off.
        let closed = |c: &Candidate| {
            let size = assembly.pair_size(&contact.pairs.get(c.pair as usize));
            if state.reaction(c.key()).is_some() { round_off.max(CONTROL.closed * size) } else { round_off }
        };
        let starts_from_nothing = interval.starts_from_nothing();
        let mut at_starts = self.contacts.iter();
        self.candidates.retain(|c| {
            let Some(at_start) = at_starts.next() else { return false };
            let interference = given.interference(c.key());
            let gap = at_start.gap - interference[0];
            let is_beyond = || {
                let inside = inside(c);
                at_start.gap < -inside && contact.is_beyond(c, at_start, inside, &start, search)
            };
            let closed = closed(c);
            let is_stopped = || {
                let known = state.reaction(c.key());
                needed.binary_search(&c.key()).is_ok() || goes_on_pressing(given, known, at_start, gap, fall)
            };
            let is_active = || method.condition.is_active(gap, closed, is_stopped);
            let takes_part = || !c.redundant && is_active() && !is_beyond();
            let active = answers(assembly, at_start) && (state.is_bond(c.key(), assembly) || takes_part());
            if active {
                let stays = gap < 0.0
                    && !starts_from_nothing
                    && (contact.is_two_sided(c.pair as usize)
                        || !map.is_static() && is_stuck(c, at_start, gap));
                self.interferences.push(interference);
                self.adhesions.push(given.adhesion(c, at_start, gap <= closed));
                let condition = given.condition_of(c.pair);
                // What holds neither closes nor opens.
                let holds = self.adhesions.last().is_some_and(Option::is_some) && !condition.rules_gaps();
                self.start_gaps.push(if holds { 0.0 } else { condition.start_gap(gap, closed, stays) });
            }
            active
        });
        self.recall(given, at_rest);
    }

    /// What is known of the contacts from the step before, and whom they touch.
    fn recall(&mut self, given: &Given<'_, D>, at_rest: &AtRest) {
        let (pairs, reactions) = (&given.assembly.contact.pairs, &given.state.reactions);
        self.contacts.clear();
        self.at_kink.clear();
        self.frames.clear();
        self.reactions.clear();
        self.friction.clear();
        self.unsettled = 0.0;
        self.start_forces.clear();
        self.touched.copy_from_slice(&given.assembly.is_connected);
        self.conditions.clear();
        self.weights.clear();
        self.bonds.clear();
        for (candidate, adhesion) in self.candidates.iter().zip(&self.adhesions) {
            let known = given.state.reaction(candidate.key());
            let force = known.map_or_else(Vector::zeros, |r| r.force);
            let condition = given.condition_of(candidate.pair);
            let weight = condition.reaction_weight(&given.interval.map);
            self.conditions.push(condition);
            self.weights.push(weight);
            self.frames.push(known.map_or_else(Matrix::zeros, |r| r.contact.frame));
            self.reactions.push(force * weight);
            if let (Some(r), Some(adhesion)) = (self.reactions.last_mut(), adhesion) {
                r[0] += adhesion * weight;
            }
            self.start_forces.push(force);
            let pair = pairs.get(candidate.pair as usize);
            let is_bond = adhesion.is_some() && given.assembly.is_unbreakable(candidate.pair);
            let own = if given.assembly.can_slide(candidate) { pair.friction } else { 0.0 };
            self.friction.push(if is_bond { OF_BONDS } else { own });
            if let (true, Some(known)) = (is_bond, known) {
                self.bonds.push((self.reactions.len() - 1, known.contact.clone()));
            }
            touch(&mut self.touched, &pair);
        }
        self.recall_sliding(given);
        // Contacts that the step starts with and that are out of reach by its end still share their bodies' balance. Those of what rests stay.
        self.lost.clear();
        if !given.method.condition.is_massless() {
            return;
        }
        for (k, reaction) in reactions.iter().enumerate() {
            let is_massless = given.condition_of(reaction.pair).is_massless();
            let pair = pairs.get(reaction.pair as usize);
            if is_massless
                && !at_rest.are_still(&pair)
                && self.candidates.binary_search_by_key(&reaction.key(), Candidate::key).is_err()
            {
                self.lost.push(k);
                touch(&mut self.touched, &pair);
            }
        }
    }

    /// Evaluates the contacts where the condition is written, their gaps less their interference, in frames that follow those before: reactions
    /// are known in these.
    pub fn evaluate(&mut self, given: &Given<'_, D>, motion: &[Vector<D>]) {
        self.place(given, motion);
        self.stand_off();
        self.follow_frames(given, motion);
    }

    /// Evaluates the contacts at the configurations of their conditions.
    fn place(&mut self, given: &Given<'_, D>, motion: &[Vector<D>]) {
        let Self { candidates, conditions, mortar, contacts, bonds, .. } = self;
        contacts.clear();
        for alike in conditions.chunk_by(|a, b| a == b) {
            let candidates = &candidates[contacts.len()..][..alike.len()];
            let position = evaluated_at(given, motion, alike[0]);
            given.assembly.contact.evaluate_more(candidates, &position, mortar, contacts);
        }
        for (i, bond) in bonds {
            contacts[*i] = bond.moved(&evaluated_at(given, motion, conditions[*i]));
        }
    }

    /// [`Self::evaluate`] where the last correction was of `correction` [m], late in the iterations of a step. A contact whose normal turns by
    /// more than such a motion explains stands at a kink of its target. It keeps its normal and stencil from now on: any normal between those of
    /// both sides will do there, and with either of them the reaction would push it to the other side.
    pub fn evaluate_late(&mut self, given: &Given<'_, D>, motion: &[Vector<D>], correction: f64) {
        let contact = &given.assembly.contact;
        std::mem::swap(&mut self.before, &mut self.contacts);
        self.place(given, motion);
        self.at_kink.resize(self.candidates.len(), false);
        let contacts = self.contacts.iter_mut().zip(&self.before).zip(&mut self.at_kink);
        let ruled = self.candidates.iter().zip(&self.conditions);
        for (((contact_now, before), at_kink), (candidate, condition)) in contacts.zip(ruled) {
            let turn = (contact_now.frame.row(0) - before.frame.row(0)).norm();
            let size = given.assembly.pair_size(&contact.pairs.get(candidate.pair as usize));
            *at_kink |= turn * size > CONTROL.kink * correction && turn > CONTROL.straight;
            if *at_kink {
                *contact_now = before.moved(&evaluated_at(given, motion, *condition));
            }
        }
        self.stand_off();
        self.follow_frames(given, motion);
    }

    /// Takes the interference off the gaps.
    fn stand_off(&mut self) {
        let ruled = self.interferences.iter().zip(&self.conditions);
        for (contact, ([h0, h1], condition)) in self.contacts.iter_mut().zip(ruled) {
            let weight = condition.evaluation_weight();
            contact.gap -= h0 * (1.0 - weight) + h1 * weight;
        }
    }

    /// Turns the frames to where those before were, or to where friction has its directions.
    fn follow_frames(&mut self, given: &Given<'_, D>, motion: &[Vector<D>]) {
        let assembly = given.assembly;
        let contacts = self.contacts.iter_mut().zip(&mut self.frames).enumerate();
        let ruled = self.candidates.iter().zip(&self.conditions);
        for ((i, (contact, frame)), (candidate, condition)) in contacts.zip(ruled) {
            match assembly.orthotropies.of(candidate.pair, &assembly.contact) {
                Some(orthotropy) => {
                    let by_law = slider_of(&self.sliders, i).and_then(|slider| slider.lengths);
                    orthotropy.orient(contact, by_law, &evaluated_at(given, motion, *condition));
                }
                None => contact.carry_frame(frame),
            }
            *frame = contact.frame;
        }
    }

    /// What the motions of the contacts lack of the variables of condition and friction [m], at a guess.
    pub fn offsets<'a>(
        &'a self,
        given: &'a Given<'_, D>,
        motion: &'a [Vector<D>],
    ) -> impl Iterator<Item = Vector<D>> + 'a {
        let Given { assembly, state, interval, .. } = *given;
        let contacts = self.contacts.iter().zip(&self.start_gaps).zip(&self.interferences);
        let contacts = contacts.zip(self.candidates.iter().zip(&self.meeting).zip(&self.conditions));
        contacts.map(move |(((contact, &start_gap), [h0, h1]), ((candidate, met), condition))| {
            let opening = Opening { start_gap, widening: h1 - h0 };
            let pair = || assembly.contact.pairs.get(candidate.pair as usize);
            if assembly.restitutions.default.is_some()
                && let Some(restitution) = assembly.restitutions.of(&pair())
            {
                return impact_offset(met, opening.widening, restitution, &interval.map);
            }
            let velocity = |n: usize| state.velocity[n];
            let along = condition.normal_offset(contact, opening, &interval.map, |n| motion[n], velocity);
            Vector::from_fn(|i, _| if i == 0 { along } else { 0.0 })
        })
    }

    /// Notes at which velocities the contacts of rigid pairs meet: those of the start of the step, where bodies have turned half way.
    pub fn meet(&mut self, given: &Given<'_, D>, bodies: &[Box<dyn Body<D>>]) {
        let Given { assembly, state, .. } = *given;
        let of_node = |n: usize| match assembly.place_of(n) {
            Some((body, own)) => bodies[body].velocity_half_way(own as u32, &state.velocity[n]),
            None => state.velocity[n],
        };
        self.meeting.clear();
        self.meeting.extend(self.candidates.iter().zip(&self.contacts).map(|(candidate, contact)| {
            match assembly.restitutions.of(&assembly.contact.pairs.get(candidate.pair as usize)) {
                Some(_) => contact.relative(of_node),
                None => Vector::zeros(),
            }
        }));
    }

    /// Those of the contacts that have one of these `reactions`, which are in the order of their candidates: the place of the contact, then that
    /// of the reaction.
    pub fn pressing<'a>(
        &'a self,
        reactions: &'a [Reaction<D>],
    ) -> impl Iterator<Item = (usize, usize, &'a Reaction<D>)> {
        let mut reactions = reactions.iter().enumerate().peekable();
        self.candidates.iter().enumerate().filter_map(move |(i, candidate)| {
            // Those of bodies that rest have no part in the step.
            while reactions.next_if(|(_, r)| r.key() < candidate.key()).is_some() {}
            let (k, reaction) = reactions.next_if(|(_, r)| r.key() == candidate.key())?;
            Some((i, k, reaction))
        })
    }

    /// Contact `k` of a blended step, and its reactions [N] at the start and the end; those that are lost come after the others.
    pub fn with_forces<'a>(&'a self, k: usize, state: &'a State<D>) -> (&'a Contact<D>, [Vector<D>; 2]) {
        match k.checked_sub(self.contacts.len()) {
            None => (&self.contacts[k], [self.start_forces[k], self.reactions[k] / self.weights[k]]),
            Some(lost) => {
                let reaction = &state.reactions[self.lost[lost]];
                (&reaction.contact, [reaction.force, Vector::zeros()])
            }
        }
    }

    /// The least that the reduced problem has of a reaction: 1 without contacts.
    pub fn least_weight(&self) -> f64 {
        self.weights.iter().copied().fold(1.0, f64::min)
    }

    /// Adds the reactions known so far to `forces` [N].
    pub fn add_reactions(&self, forces: &mut [Vector<D>]) {
        for (contact, r) in self.contacts.iter().zip(self.all_acting()) {
            contact.add_force(&r, forces);
        }
    }
}

/// Where nodes are [m] when a contact is evaluated that this condition rules.
fn evaluated_at<'a, const D: usize>(
    given: &'a Given<'_, D>,
    motion: &'a [Vector<D>],
    condition: ContactCondition,
) -> impl Fn(u32) -> Vector<D> + 'a {
    let weight = condition.evaluation_weight();
    move |n| given.position(n) + motion[n as usize] * weight
}

/// Whether a normal reaction could move anything: not where both sides are prescribed, as where a support stands on an obstacle.
fn answers<const D: usize>(assembly: &Assembly<D>, contact: &Contact<D>) -> bool {
    let normal = contact.frame.row(0).transpose();
    contact
        .stencil()
        .any(|(n, weight)| (assembly.free_part(n, &normal) * weight).norm() > CONTROL.unresponsive)
}

fn touch(touched: &mut [bool], pair: &Pair) {
    touched[pair.source] = true;
    if let Target::Surface(target) = pair.target {
        touched[target] = true;
    }
}

/// Whether a contact that pressed in the last step, was `at_start` with this `gap` [m] and becomes no faster than by `fall` [m/s] in free flight would
/// have to be stopped again.
fn goes_on_pressing<const D: usize>(
    given: &Given<'_, D>,
    known: Option<&Reaction<D>>,
    at_start: &Contact<D>,
    gap: f64,
    fall: f64,
) -> bool {
    let closing = || (-at_start.relative(|n| given.state.velocity[n])[0]).max(0.0) + fall;
    known.is_some_and(|r| r.force[0] > 0.0) && gap < CONTROL.stopping * closing() * given.interval.map.dt
}
