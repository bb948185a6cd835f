//! What normal reactions take where contacts close, and get back.

use carom_mesh::Vector;

use super::control::IMPULSIVE;
use super::impulse::{Group, Impulse, Impulses, mass, sticks, tangential};
use super::workspace::Workspace;
use crate::body::Body;
use crate::contact::Contacts;
use crate::model::given::Given;
use crate::model::state::State;

/// Gives back what normal reactions took on landing, −r_n (H d)_n > 0, by impulses along the normals (Laursen & Love 2002). So no node is let in,
/// and normal reactions take no energy.
///
/// A contact that closes the gap g in the step is left with less velocity, by b g with v₊ = a v + b d, than one that was closed and came no
/// closer. The impulse is what one node lacks for it, m b g. Where a contact slides on, the impulse has its share of friction.
pub(super) fn restore<const D: usize>(given: &Given<'_, D>, new: &mut State<D>, work: &mut Workspace<D>) {
    let Workspace { bodies, contacts, impulses, motion, body_ledgers, .. } = work;
    impulses.wanted.clear();
    impulses.arriving.clear();
    if !given.method.restores() {
        return;
    }
    let Contacts { active, at_end, .. } = &*contacts;
    let map = &given.interval.map;
    for (i, k, reaction) in active.pressing(&new.reactions) {
        let gap = active.start_gaps[i];
        if gap <= 0.0 {
            continue;
        }
        let mut impulse = Vector::zeros();
        impulse[0] = mass(&at_end[i], given.assembly, bodies) * gap * map.velocity_of_motion;
        if reaction.force[0] * map.dt > IMPULSIVE.has_landed * impulse[0] {
            let [h0, h1] = active.interferences[i];
            let energy = -reaction.force[0] * (reaction.contact.relative(|n| motion[n])[0] - (h1 - h0));
            impulses.wanted.push(Impulse { reaction: k, contact: i, impulse, energy });
        } else {
            impulses.arriving.push(k);
        }
    }
    if impulses.wanted.is_empty() {
        return;
    }
    impulses.weigh(given, at_end, bodies, new);
    rub(given, new, contacts, bodies, impulses);
    impulses.give(given, &contacts.at_end, new, body_ledgers, restoring);
}

/// The number that impulses are to be scaled by to give their energy: s λ·H v + ½ s² λ·H Δv = E along the normals. One solution is positive and
/// turns round what still approaches; it would be 1 for a node alone.
///
/// What parted faster at the start than it could close its gap was pushed there and approaches at the end by far more than λ makes good. There
/// was no landing, and as gaps get smaller, E vanishes and the positive solution does not: such a group takes the negative one, which does.
fn restoring(group: &Group) -> f64 {
    let ([work, _], [square, _], energy) = (group.work, group.square, group.energy);
    if square <= 0.0 || energy <= 0.0 {
        return 0.0;
    }
    let root = (work * work + 2.0 * square * energy).sqrt();
    if work > 0.0 {
        2.0 * energy / (root + work)
    } else if -work > IMPULSIVE.pushed * square {
        -2.0 * energy / (root - work)
    } else {
        (root - work) / square
    }
}

/// Gives the impulses Coulomb's friction against the velocity that they meet, where the contact does not stick. As in a step with θ = ½ it may turn
/// a velocity round, but not make it larger: friction takes energy at every contact, or there is none.
fn rub<const D: usize>(
    given: &Given<'_, D>,
    new: &State<D>,
    contacts: &Contacts<D>,
    bodies: &mut [Box<dyn Body<D>>],
    impulses: &mut Impulses<D>,
) {
    let Contacts { active, at_end, .. } = contacts;
    let mut rubs = false;
    let dt = given.interval.map.dt;
    for Impulse { reaction, contact, impulse, .. } in &mut impulses.wanted {
        let v = at_end[*contact].relative(|n| new.velocity[n]);
        let speed = tangential(&v);
        let friction = active.friction[*contact];
        let force = &new.reactions[*reaction].force;
        let is_known = force[0] * dt > IMPULSIVE.is_known * impulse[0];
        if friction > 0.0 && speed > 0.0 && !(is_known && sticks(force, friction)) {
            let turns = 2.0 * mass(&at_end[*contact], given.assembly, bodies);
            let most = friction * impulse[0] / speed;
            (1..D).for_each(|t| impulse[t] = -v[t] * turns.min(most));
            rubs = true;
        }
    }
    for round in 1..=IMPULSIVE.rounds {
        if !rubs {
            return;
        }
        impulses.weigh(given, at_end, bodies, new);
        let mut wanted = std::mem::take(&mut impulses.wanted);
        rubs = false;
        for impulse in &mut wanted {
            let [_, across] = impulses.taken(given, at_end, new, impulse, restoring);
            if across < 0.0 || round == IMPULSIVE.rounds - 1 {
                (1..D).for_each(|t| impulse.impulse[t] = 0.0);
                rubs = true;
            }
        }
        impulses.wanted = wanted;
    }
}
