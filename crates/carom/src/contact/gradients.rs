//! How contacts change as their nodes move: the stiffness of their reactions, and what their rows leave out.
//!
//! The stiffness of reactions is G = −∂(Hᵀr)/∂u, as normals turn and targets curve. With friction, and where weights are means, it is not symmetric.
//!
//! The motion that is ruled is w = H(u) d, or a gap, and its row H the gradient where H stays. What follows the motion is left out: frames that turn
//! while bodies approach or slide, by as much of the way of the step; and weights. A gap of a node knows its gradient, as closest points are. That of a mortar
//! row is g = n · Σ a(u) x: where two coarse sides lie on one another in the mean alone, the rest of its gradient is as large as the row, and
//! iterations without it converge by 0.8 at best. With the whole gradient H̃ W is H̃ K⁻¹ Hᵀ, and not symmetric either.
//!
//! What the tangent lacks costs a rate where contacts answer as they should. Where they are redundant, how they share what they bear hangs on next to
//! nothing, and what is left out as 1 % of a correction can move them by all of it: iterations go round and round.
//!
//! Gradients come from central differences, node by node over the contacts that know the node.

use carom_contact::{Candidate, Contact, Mortar, Site};
use carom_mesh::{Matrix, Vector};

use super::active::ActiveSet;
use super::control::CONTROL;
use super::woodbury::Woodbury;
use crate::model::condition::ContactCondition;
use crate::model::given::Given;

/// No place.
pub(super) const NONE: u32 = u32::MAX;

/// Parts of the gradient of what rules a contact, by the places of their nodes in P: a row for every direction of its frame.
type Parts<const D: usize> = Vec<(u32, Matrix<D>)>;

/// What rows leave out of their gradients at a guess, and scratch.
#[derive(Debug, Default)]
pub(super) struct Gradients<const D: usize> {
    /// Contact by contact; the last ones may be missing.
    parts: Vec<Parts<D>>,
    /// The contacts that know a node: the node, then the contact.
    known_to: Vec<(usize, usize)>,
    /// These contacts, where they are when the node has moved, and what makes them.
    candidates: Vec<Candidate>,
    moved: Vec<Contact<D>>,
    mortar: Mortar<D>,
}

impl<const D: usize> Gradients<D> {
    /// Forgets all.
    pub fn clear(&mut self) {
        self.parts.iter_mut().for_each(Vec::clear);
    }

    /// Whether there is something.
    pub fn is_some(&self) -> bool {
        self.parts.iter().any(|parts| !parts.is_empty())
    }

    /// What the row of contact `i` leaves out.
    pub fn of(&self, i: usize) -> &[(u32, Matrix<D>)] {
        self.parts.get(i).map_or(&[], |parts| parts)
    }

    /// Makes it at a guess whose contacts were evaluated, and adds the stiffness of the reactions to Ĝ. Of contacts that are no mortar rows it is
    /// the symmetric part of the stiffness and nothing else, unless the `whole` is wanted. `places` are those of P.
    pub fn make(
        &mut self,
        given: &Given<'_, D>,
        active: &ActiveSet<D>,
        motion: &[Vector<D>],
        (places, whole): (&[u32], bool),
        stiffness: &mut Woodbury<D>,
    ) {
        let is_fixed = |k: &usize| active.at_kink.get(*k).is_some_and(|at_kink| *at_kink);
        let changes =
            |k: &usize| whole || is_row(&active.candidates[*k]) || active.acting(*k) != Vector::<D>::zeros();
        let contacts =
            (0..active.contacts.len()).filter(|k| !is_fixed(k) && !active.is_bond(*k) && changes(k));
        self.known_to.clear();
        self.known_to.extend(contacts.flat_map(|k| active.contacts[k].stencil().map(move |(n, _)| (n, k))));
        if self.known_to.is_empty() {
            return;
        }
        self.known_to.sort_unstable();
        self.mortar.clone_from(&active.mortar);
        self.parts.resize_with(active.contacts.len(), Vec::new);
        let known_to = std::mem::take(&mut self.known_to);
        let alike = |a: &(usize, usize), b: &(usize, usize)| {
            a.0 == b.0 && active.conditions[a.1] == active.conditions[b.1]
        };
        for of_node in known_to.chunk_by(alike) {
            if places[of_node[0].0] != NONE {
                self.move_node(given, (active, motion), of_node, (places, whole), stiffness);
            }
        }
        self.known_to = known_to;
    }

    /// Moves a node to and fro, along every axis, and takes note of what the contacts `of_node` that know it make of it.
    fn move_node(
        &mut self,
        given: &Given<'_, D>,
        (active, motion): (&ActiveSet<D>, &[Vector<D>]),
        of_node: &[(usize, usize)],
        (places, whole): (&[u32], bool),
        stiffness: &mut Woodbury<D>,
    ) {
        let model = &given.assembly.contact;
        let node = of_node[0].0;
        let column = places[node];
        self.candidates.clear();
        self.candidates.extend(of_node.iter().map(|&(_, k)| active.candidates[k]));
        let size = |c: &Candidate| given.assembly.pair_size(&model.pairs.get(c.pair as usize));
        let step = CONTROL.difference * self.candidates.iter().map(size).fold(f64::INFINITY, f64::min);
        let condition = active.conditions[of_node[0].1];
        let evaluated = condition.evaluation_weight();
        for (&(_, k), candidate) in of_node.iter().zip(&self.candidates) {
            if !whole && !is_row(candidate) {
                continue;
            }
            let contact = &active.contacts[k];
            let weight = contact.stencil().find(|&(n, _)| n == node).map_or(0.0, |(_, weight)| weight);
            // The whole gradient of a gap has the row in it, that of the motion of a row whose nodes stay where they are has not.
            let known = if condition.rules_gaps() { -weight } else { 0.0 };
            let mut part = Matrix::<D>::zeros();
            part.set_row(0, &(contact.frame.row(0) * known));
            self.parts[k].push((column, part));
        }
        let map = &given.interval.map;
        let carried = if map.is_static() { 0.0 } else { map.velocity_of_velocity / map.velocity_of_motion };
        let ruled = |contact: &Contact<D>| {
            let mut w = contact.relative(|n| motion[n]);
            match condition {
                ContactCondition::Gap | ContactCondition::Massless => w[0] = contact.gap,
                ContactCondition::Midpoint => {}
                ContactCondition::Endpoint => {
                    w[0] = contact.relative(|n| motion[n] + given.state.velocity[n] * carried)[0];
                }
            }
            w
        };
        for component in 0..D {
            for sign in [1.0, -1.0] {
                let position = |n: u32| {
                    let mut x = given.position(n) + motion[n as usize] * evaluated;
                    if n as usize == node {
                        x[component] += sign * step;
                    }
                    x
                };
                model.evaluate_all(&self.candidates, &position, &mut self.mortar, &mut self.moved);
                let share = evaluated * sign / (2.0 * step);
                for ((&(_, k), candidate), moved) in of_node.iter().zip(&self.candidates).zip(&mut self.moved)
                {
                    moved.carry_frame(&active.contacts[k].frame);
                    let is_whole = whole || is_row(candidate);
                    if is_whole && let Some((_, part)) = self.parts[k].last_mut() {
                        let change = ruled(moved) * share;
                        // Of mortar rows their gaps alone, as long as that is enough.
                        let rows = if whole { D } else { 1 };
                        (0..rows).for_each(|row| part[(row, component)] += change[row]);
                    }
                    let r = active.acting(k);
                    if r == Vector::<D>::zeros() {
                        continue;
                    }
                    let force = moved.frame.tr_mul(&(r * -share));
                    for (n, weight) in moved.stencil().filter(|&(n, _)| places[n] != NONE) {
                        let mut block = Matrix::<D>::zeros();
                        block.set_column(component, &(force * weight));
                        let place = (places[n] as usize, column as usize);
                        if is_whole {
                            stiffness.add(place, block);
                        } else {
                            // Friction makes it unsymmetric, of which most solvers of contacts know nothing.
                            stiffness.add(place, block * 0.5);
                            stiffness.add((place.1, place.0), block.transpose() * 0.5);
                        }
                    }
                }
            }
        }
    }
}

/// Whether a candidate is a row of a mortar pair.
fn is_row(candidate: &Candidate) -> bool {
    matches!(candidate.site, Site::Multiplier(..))
}
