//! Rest is rest: what damping takes from the velocities that closed contacts turn round.

use carom_mesh::Vector;

use super::control::IMPULSIVE;
use super::impulse::{Group, Impulse, mass, sticks, tangential};
use super::iterating::Iterating;
use super::workspace::Workspace;
use crate::body::Body;
use crate::contact::Contacts;
use crate::model::given::Given;
use crate::model::sliding::SlidingRecord;
use crate::model::state::State;

/// Takes from the velocities of a new state what closed contacts turn round in every step.
///
/// With θ = ½ a step is v₊ = 2d/Δt − v. A contact that stays closed, or sticks, has d = 0: its relative velocity changes sign in every step
/// and is that of no motion. Damping, which knows d/Δt, never sees it. Its energy is what the nodes had when they met. Where nothing is
/// damped they keep it until they part; where bodies are, it goes at the rate at which damping would take the energy of that motion.
///
/// It goes by impulses in the contacts, which are part of the reactions and stay within their cones. So momenta are kept, and nothing
/// moves that was closed. They are λ = −m H v, with the mass that a contact puts in their way and the length that leaves the least
/// energy: a step of steepest descent in every step in time.
pub(super) fn settle<const D: usize>(given: &Given<'_, D>, new: &mut State<D>, work: &mut Workspace<D>) {
    let Given { method, interval, .. } = *given;
    let Workspace { iterating: Iterating { bodies, contacts, .. }, impulses, body_ledgers, .. } = work;
    impulses.wanted.clear();
    stop(given, new, contacts, bodies, &mut impulses.wanted);
    let stops = !impulses.wanted.is_empty();
    if !stops && method.settles() && !new.reactions.is_empty() && bodies.iter().any(|body| body.is_damped()) {
        choose(given, new, contacts, bodies, &mut impulses.wanted);
    }
    if impulses.wanted.is_empty() {
        return;
    }
    let dt = interval.map.dt;
    impulses.weigh(given, &contacts.at_end, bodies.as_mut_slice(), new);
    impulses.give(given, &contacts.at_end, new, body_ledgers, |group: &Group| {
        let [work, square] = [group.work, group.square].map(|[along, across]| along + across);
        if square <= 0.0 || work >= 0.0 {
            return 0.0;
        }
        if stops {
            return (-work / square).min(IMPULSIVE.borne);
        }
        let rate = group.power / square;
        (-work / square).min(IMPULSIVE.borne) * -(-rate * dt).exp_m1()
    });
}

/// Chooses the contacts that a friction law which holds more than it resists has at rest, and the impulses that leave them no velocity along their target:
/// those that stick, as the force that turns this velocity round in every step would else be taken from what they hold; and those whose slip has turned
/// round at the end of the step, which came to rest in it and stick from now on, if that holds them.
fn stop<const D: usize>(
    given: &Given<'_, D>,
    new: &mut State<D>,
    contacts: &Contacts<D>,
    bodies: &[Box<dyn Body<D>>],
    out: &mut Vec<Impulse<D>>,
) {
    let Contacts { active, at_end, .. } = contacts;
    if active.sliders.is_empty() || given.interval.map.is_static() {
        return;
    }
    let (dt, State { reactions, sliding, velocity, .. }) = (given.interval.map.dt, new);
    for (i, k, reaction) in active.pressing(reactions) {
        let Some((holding, slid)) = active.holding(given, i) else { continue };
        let mut across = at_end[i].relative(|n| velocity[n]);
        across[0] = 0.0;
        let sticks = slid == Vector::<D>::zeros();
        if !sticks && at_end[i].frame.tr_mul(&across).dot(&slid) >= 0.0 {
            continue;
        }
        let impulse = across * -mass(&at_end[i], given.assembly, bodies);
        // The reaction of one that stuck turned its velocity round; half of that is what it would take to stop it.
        let times = if sticks { IMPULSIVE.borne } else { 1.0 };
        let pressing = reaction.in_cone();
        let left = pressing + impulse * (times / dt);
        let is_moving = impulse.norm() > IMPULSIVE.at_rest * pressing[0] * dt;
        if !is_moving || tangential(&left) > holding * left[0] {
            continue;
        }
        out.push(Impulse { reaction: k, contact: i, impulse, energy: 0.0 });
        if let Ok(record) = sliding.binary_search_by_key(&reaction.key(), SlidingRecord::key) {
            sliding[record].direction = Vector::zeros();
        }
    }
}

/// Chooses the contacts that press for longer than this step and were closed at its start, and their impulses.
fn choose<const D: usize>(
    given: &Given<'_, D>,
    new: &State<D>,
    contacts: &Contacts<D>,
    bodies: &[Box<dyn Body<D>>],
    out: &mut Vec<Impulse<D>>,
) {
    let Given { assembly, state, interval, .. } = *given;
    let dt = interval.map.dt;
    let Contacts { active, at_end, .. } = contacts;
    for (i, k, reaction) in active.pressing(&new.reactions) {
        // What is in static balance has no such velocity.
        if active.conditions[i].is_massless() {
            continue;
        }
        // Surfaces that are being pushed apart are not at rest.
        let [h0, h1] = active.interferences[i];
        if state.reaction(reaction.key()).is_none() || active.start_gaps[i] > 0.0 || h0 != h1 {
            continue;
        }
        let (r, mu) = (&reaction.in_cone(), active.friction[i]);
        let velocity = at_end[i].relative(|n| new.velocity[n]);
        let mut impulse = velocity * -mass(&at_end[i], assembly, bodies);
        if !sticks(r, mu) {
            (1..D).for_each(|t| impulse[t] = 0.0);
        }
        if impulse.norm() <= IMPULSIVE.at_rest * r[0] * dt {
            continue;
        }
        let left = |part: f64| r + impulse * (part * IMPULSIVE.borne / dt);
        let is_borne = |part: &f64| left(*part)[0] > 0.0 && tangential(&left(*part)) <= mu * left(*part)[0];
        let part = [1.0, 0.5, 0.25, 0.125].into_iter().find(is_borne);
        out.extend(part.map(|part| Impulse {
            reaction: k,
            contact: i,
            impulse: impulse * part,
            energy: 0.0,
        }));
    }
}
