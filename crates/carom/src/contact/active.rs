//! Which contacts take part in a step.

use carom_contact::{Candidate, Contact, Pair, Target};
use carom_mesh::{Matrix, Vector};

use crate::model::state::{Reaction, State};
use crate::step::workspace::Workspace;
use crate::{Method, Model, StepMap};

/// A contact of which less than this fraction of the normal is free has nothing to move.
const UNRESPONSIVE: f64 = 1e-6;
/// A node this deep inside its target, in sizes of the smaller body, is more than touching it.
const INSIDE: f64 = 1e-6;
/// By how much the margin grows for mortar pairs with every repetition of a search.
const WIDENING: f64 = 4.0;

/// Finds the candidates of the step between its start and the predicted end; another time between its start and where it led to, beside
/// those already found and those missed there.
///
/// Nodes are not looked for farther and farther away: in a fast step that would be all there are, and their problem dense. Only
/// the rows of mortar pairs, which cannot be recalled, are found by a wider margin.
pub(crate) fn search<const D: usize>(
    model: &Model<D>,
    state: &State<D>,
    margin: f64,
    repetition: usize,
    work: &mut Workspace<D>,
) {
    let start = |n: u32| model.reference[n as usize] + state.displacement[n as usize];
    let motion = &work.motion;
    let end = |n: u32| start(n) + motion[n as usize];
    let Workspace { search, mortar, candidates, searched, .. } = work;
    model.contact.detect(&start, &end, margin, search, candidates);
    if repetition > 0 {
        model.contact.recall(searched, &start, &end, candidates);
    }
    let wide = margin * WIDENING.powi(repetition as i32);
    model.contact.detect_mortar(&start, &end, wide, mortar, candidates);
    searched.clone_from(candidates);
}

/// Keeps the candidates that take part in the step and recalls their last reactions.
///
/// A node that is found deeper inside its target than its velocity explains has not just got there: it slid past an edge that no node
/// of the other side saw. It is kept from going deeper, until the bodies part: to push it out at once, the faster the shorter the step,
/// would create energy. In a static analysis it is pushed out: there bodies may be meant to be pressed into one another.
pub(crate) fn select_active<const D: usize>(
    model: &Model<D>,
    method: &Method<D>,
    state: &State<D>,
    map: &StepMap,
    work: &mut Workspace<D>,
) {
    let start = |n: u32| model.reference[n as usize] + state.displacement[n as usize];
    let contact = &model.contact;
    work.start_gaps.clear();
    contact.evaluate_all(&work.candidates, &start, &mut work.mortar, &mut work.contacts);
    let round_off = model.round_off();
    let inside = |c: &Candidate| INSIDE * model.pair_size(&contact.pairs[c.pair as usize]);
    let is_stuck = |c: &Candidate, at_start: &Contact<D>| {
        let inside = inside(c);
        let was_stuck = |k: usize| state.reactions[k].contact.gap < -inside;
        let known = state.reactions.binary_search_by_key(&c.key(), Reaction::key);
        let explained = inside + map.dt * at_start.relative(|n| state.velocity[n]).norm();
        at_start.gap < -explained || known.is_ok_and(was_stuck)
    };
    let mut at_starts = work.contacts.iter();
    work.candidates.retain(|c| {
        let Some(at_start) = at_starts.next() else { return false };
        let gap = at_start.gap;
        let is_beyond = || {
            let inside = inside(c);
            gap < -inside && contact.is_beyond(c, at_start, inside, &start, &work.search)
        };
        let active = !c.mirrored
            && method.condition.is_active(gap, round_off)
            && answers(model, at_start)
            && !is_beyond();
        if active {
            let stays = gap < 0.0
                && (contact.is_two_sided(c.pair as usize) || !map.is_static() && is_stuck(c, at_start));
            work.start_gaps.push(if stays { gap } else { 0.0 });
        }
        active
    });
    work.contacts.clear();
    work.frames.clear();
    work.reactions.clear();
    work.friction.clear();
    work.start_forces.clear();
    work.touched.fill(false);
    let weight = method.condition.reaction_weight(map);
    for candidate in &work.candidates {
        let known = state.reactions.binary_search_by_key(&candidate.key(), Reaction::key);
        let known = known.map(|k| &state.reactions[k]);
        let force = known.map_or_else(|_| Vector::zeros(), |r| r.force);
        work.frames.push(known.map_or_else(|_| Matrix::zeros(), |r| r.contact.frame));
        work.reactions.push(force * weight);
        work.start_forces.push(force);
        work.friction.push(contact.pairs[candidate.pair as usize].friction);
        touch(&mut work.touched, &contact.pairs[candidate.pair as usize]);
    }
    // Contacts that the step starts with and that are out of reach by its end still share their bodies' balance.
    work.lost.clear();
    if !method.condition.is_massless() {
        return;
    }
    for (k, reaction) in state.reactions.iter().enumerate() {
        if work.candidates.binary_search_by_key(&reaction.key(), Candidate::key).is_err() {
            work.lost.push(k);
            touch(&mut work.touched, &contact.pairs[reaction.pair as usize]);
        }
    }
}

/// Whether a normal reaction could move anything: not where both sides are prescribed, as where a support stands on an obstacle.
fn answers<const D: usize>(model: &Model<D>, contact: &Contact<D>) -> bool {
    let normal = contact.frame.row(0).transpose();
    contact.stencil().any(|(n, weight)| (model.free_part(n, &normal) * weight).norm() > UNRESPONSIVE)
}

fn touch(touched: &mut [bool], pair: &Pair) {
    touched[pair.source] = true;
    if let Target::Surface(target) = pair.target {
        touched[target] = true;
    }
}

/// Whether a node that the search did not find has gone through its target by the end of the step; if so, what was missed is searched
/// from now on.
///
/// Only where the condition is written there: the others choose their contacts at the start.
pub(crate) fn missed_a_contact<const D: usize>(
    model: &Model<D>,
    method: &Method<D>,
    next: &State<D>,
    work: &mut Workspace<D>,
) -> bool {
    if !method.condition.rules_the_end() {
        return false;
    }
    let end = |n: u32| model.reference[n as usize] + next.displacement[n as usize];
    let Workspace { search, searched, missed, missed_mortar, end_contacts, .. } = work;
    model.contact.detect(&end, &end, 0.0, search, missed);
    model.contact.detect_mortar(&end, &end, 0.0, missed_mortar, missed);
    missed.retain(|m| searched.binary_search_by_key(&m.key(), Candidate::key).is_err());
    model.contact.evaluate_all(missed, &end, missed_mortar, end_contacts);
    let missed_one = end_contacts.iter().any(|c| c.gap < -model.round_off());
    if missed_one {
        searched.extend_from_slice(missed);
        searched.sort_unstable();
    }
    missed_one
}
