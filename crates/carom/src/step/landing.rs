//! What normal reactions take where contacts close, and get back.

use carom_contact::Contact;
use carom_mesh::Vector;

use super::control::IMPULSIVE;
use super::impulse::{Group, Impulse, Impulses, mass, sticks, tangential};
use crate::body::Masses;
use crate::contact::active::ActiveSet;
use crate::ledger::BodyLedger;
use crate::model::given::Given;
use crate::model::state::{Reaction, State};

/// The contacts of a step that is at its end, and the bodies that meet there.
pub(crate) struct Landing<'a, const D: usize, M: ?Sized> {
    /// The contacts as they were ruled.
    pub active: &'a ActiveSet<D>,
    /// The same at the end of the step.
    pub at_end: &'a [Contact<D>],
    /// d [m] of all nodes and obstacles.
    pub motion: &'a [Vector<D>],
    /// What resists.
    pub masses: &'a mut M,
    /// What happens to the energy of bodies.
    pub ledgers: &'a mut [BodyLedger],
}

/// Gives back what normal reactions took on landing, −r_n (H d)_n > 0, by impulses along the normals (Laursen & Love 2002). So no node is let in,
/// and normal reactions take no energy.
///
/// A contact that closes the gap g in the step is left with less velocity, by b g with v₊ = a v + b d, than one that was closed and came no
/// closer. The impulse is what one node lacks for it, m b g. Where a contact slides on, the impulse has its share of friction.
pub(crate) fn restore<const D: usize, M: Masses<D> + ?Sized>(
    given: &Given<'_, D>,
    new: &mut State<D>,
    mut landing: Landing<'_, D, M>,
    impulses: &mut Impulses<D>,
) {
    let Landing { active, at_end, motion, .. } = landing;
    let masses = &mut *landing.masses;
    impulses.done.clear();
    impulses.landings = 0;
    impulses.scales.fill(0.0);
    impulses.wanted.clear();
    impulses.arriving.clear();
    if !given.method.restores() {
        return;
    }
    let map = &given.interval.map;
    for (i, k, reaction) in active.pressing(&new.reactions) {
        let gap = active.start_gaps[i];
        if gap <= 0.0 {
            continue;
        }
        let mut impulse = Vector::zeros();
        impulse[0] = mass(&at_end[i], given.assembly, masses) * gap * map.velocity_of_motion;
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
    impulses.weigh(given, at_end, masses, new);
    rub(given, new, &mut landing, impulses);
    impulses.give(given, landing.at_end, new, landing.ledgers, restoring);
    impulses.landings = impulses.done.len();
}

/// The number that impulses are to be scaled by to give their energy: s λ·H v + ½ s² λ·H Δv = E along the normals. One solution is positive and
/// turns round what still approaches; it would be 1 for a node alone.
///
/// What parted faster at the start than it could close its gap was pushed there and approaches at the end by far more than λ makes good. There
/// was no landing, and as gaps get smaller, E vanishes and the positive solution does not: such a group takes the negative one, which does, as
/// far as its reactions press.
fn restoring(group: &Group) -> f64 {
    let ([work, _], [square, _], energy) = (group.work, group.square, group.energy);
    if square <= 0.0 || energy <= 0.0 {
        return 0.0;
    }
    let root = (work * work + 2.0 * square * energy).sqrt();
    if work > 0.0 {
        2.0 * energy / (root + work)
    } else if -work > IMPULSIVE.pushed * square {
        (-2.0 * energy / (root - work)).max(-group.pressed)
    } else {
        (root - work) / square
    }
}

/// Gives the impulses Coulomb's friction.
///
/// Along the normal they push: where the contact does not stick, friction is against the velocity that they meet. As in a step with θ = ½ it may turn
/// a velocity round, but not make it larger: friction takes energy at every contact, or there is none. Where they take from the reactions, they
/// take as much of their friction; and nothing where this would give more back than it took in the step.
fn rub<const D: usize, M: Masses<D> + ?Sized>(
    given: &Given<'_, D>,
    new: &State<D>,
    landing: &mut Landing<'_, D, M>,
    impulses: &mut Impulses<D>,
) {
    let Landing { active, at_end, motion, .. } = *landing;
    let masses = &mut *landing.masses;
    let dt = given.interval.map.dt;
    let mut wanted = std::mem::take(&mut impulses.wanted);
    let mut rubs = false;
    for impulse in &mut wanted {
        let takes = impulses.scale(given, new, impulse, restoring) < 0.0;
        let Impulse { reaction, contact, ref mut impulse, .. } = *impulse;
        let (friction, force) = (active.friction[contact], &new.reactions[reaction].force);
        if takes {
            rubs |= share(impulse, force);
            continue;
        }
        let v = at_end[contact].relative(|n| new.velocity[n]);
        let speed = tangential(&v);
        let is_known = force[0] * dt > IMPULSIVE.is_known * impulse[0];
        if friction > 0.0 && speed > 0.0 && !(is_known && sticks(force, friction)) {
            let turns = 2.0 * mass(&at_end[contact], given.assembly, masses);
            let most = friction * impulse[0] / speed;
            (1..D).for_each(|t| impulse[t] = -v[t] * turns.min(most));
            rubs = true;
        }
    }
    for round in 1..=IMPULSIVE.rounds {
        impulses.wanted = wanted;
        if !rubs {
            return;
        }
        impulses.weigh(given, at_end, masses, new);
        wanted = std::mem::take(&mut impulses.wanted);
        rubs = false;
        for impulse in &mut wanted {
            let [_, across] = impulses.taken(given, at_end, new, impulse, restoring);
            let takes = impulses.scale(given, new, impulse, restoring) < 0.0;
            let reaction = &new.reactions[impulse.reaction];
            let is_last = round >= IMPULSIVE.rounds - 1;
            if takes && !is_last && share(&mut impulse.impulse, &reaction.force) {
                rubs = true;
            } else if takes && (is_last || rubbed(reaction, motion) + across < 0.0) {
                (impulse.impulse, impulse.energy) = (Vector::zeros(), 0.0);
                rubs = true;
            } else if !takes && (across < 0.0 || is_last) {
                (1..D).for_each(|t| impulse.impulse[t] = 0.0);
                rubs = true;
            }
        }
    }
    impulses.wanted = wanted;
    impulses.weigh(given, at_end, masses, new);
}

/// Gives an impulse along the normal the share of friction that the reaction `force` has, and says whether it had another.
fn share<const D: usize>(impulse: &mut Vector<D>, force: &Vector<D>) -> bool {
    let share = impulse[0] / force[0];
    let shared = Vector::<D>::from_fn(|t, _| if t == 0 { impulse[0] } else { share * force[t] });
    std::mem::replace(impulse, shared) != shared
}

/// What friction took with a reaction in the step [J].
pub(super) fn rubbed<const D: usize>(reaction: &Reaction<D>, motion: &[Vector<D>]) -> f64 {
    let w = reaction.contact.relative(|n| motion[n]);
    -(1..D).map(|t| reaction.force[t] * w[t]).sum::<f64>()
}
