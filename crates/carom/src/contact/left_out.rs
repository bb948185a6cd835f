//! What mortar rows leave out: their weights follow the motion, and neither the rows nor their forces say so.
//!
//! The gap of a row is g = n · Σ a(u) x, and the row itself the gradient with weights a that stay; what a condition rules may be the motion of the row in
//! place of its gap. Where two coarse sides lie on one another in the mean
//! alone, the rest of the gradient is as large as the row, and iterations without it converge by 0.8 at best. Here gradients
//! come from central differences, node by node over the rows that know the node. W is then H̃ K⁻¹ Hᵀ with the whole gradient H̃ in the normal rows, and
//! not symmetric; neither is G.

use carom_contact::{Candidate, Contact, Mortar, Site};
use carom_mesh::{Matrix, Vector};

use super::active::ActiveSet;
use super::control::CONTROL;
use super::woodbury::Woodbury;
use crate::model::condition::ContactCondition;
use crate::model::given::Given;

/// No place.
pub(super) const NONE: u32 = u32::MAX;

/// Parts of the gradient of a gap, by the places of their nodes in P.
type Parts<const D: usize> = Vec<(u32, Vector<D>)>;

/// What the rows leave out of the gradients of their gaps at a guess, and scratch.
#[derive(Debug, Default)]
pub(super) struct LeftOut<const D: usize> {
    /// Contact by contact; the last ones may be missing.
    parts: Vec<Parts<D>>,
    /// The rows that know a node: the node, then the contact.
    known_to: Vec<(usize, usize)>,
    /// These rows, where they are when the node has moved, and what makes them.
    candidates: Vec<Candidate>,
    moved: Vec<Contact<D>>,
    mortar: Mortar<D>,
}

impl<const D: usize> LeftOut<D> {
    /// Forgets all.
    pub fn clear(&mut self) {
        self.parts.iter_mut().for_each(Vec::clear);
    }

    /// Whether there is something.
    pub fn is_some(&self) -> bool {
        self.parts.iter().any(|parts| !parts.is_empty())
    }

    /// What the row of contact `i` leaves out.
    pub fn of(&self, i: usize) -> &[(u32, Vector<D>)] {
        self.parts.get(i).map_or(&[], |parts| parts)
    }

    /// Makes it at a guess whose contacts were evaluated, and adds the stiffness of the reactions of mortar rows to Ĝ. `places` are those of P.
    pub fn make(
        &mut self,
        given: &Given<'_, D>,
        active: &ActiveSet<D>,
        motion: &[Vector<D>],
        places: &[u32],
        stiffness: &mut Woodbury<D>,
    ) {
        let is_row = |k: &usize| matches!(active.candidates[*k].site, Site::Multiplier(..));
        let is_fixed = |k: &usize| active.at_kink.get(*k).is_some_and(|at_kink| *at_kink);
        let rows = (0..active.contacts.len()).filter(|k| is_row(k) && !is_fixed(k) && !active.is_bond(*k));
        self.known_to.clear();
        self.known_to.extend(rows.flat_map(|k| active.contacts[k].stencil().map(move |(n, _)| (n, k))));
        if self.known_to.is_empty() {
            return;
        }
        self.known_to.sort_unstable();
        self.mortar.clone_from(&active.mortar);
        self.parts.resize_with(active.contacts.len(), Vec::new);
        let known_to = std::mem::take(&mut self.known_to);
        for of_node in known_to.chunk_by(|a, b| a.0 == b.0) {
            let place = places[of_node[0].0];
            if place != NONE {
                self.move_node(given, active, motion, of_node, (places, stiffness));
            }
        }
        self.known_to = known_to;
    }

    /// Moves a node to and fro, along every axis, and takes note of what the rows `of_node` that know it make of it.
    fn move_node(
        &mut self,
        given: &Given<'_, D>,
        active: &ActiveSet<D>,
        motion: &[Vector<D>],
        of_node: &[(usize, usize)],
        (places, stiffness): (&[u32], &mut Woodbury<D>),
    ) {
        let model = &given.assembly.contact;
        let node = of_node[0].0;
        let column = places[node];
        self.candidates.clear();
        self.candidates.extend(of_node.iter().map(|&(_, k)| active.candidates[k]));
        let size = |c: &Candidate| given.assembly.pair_size(&model.pairs.get(c.pair as usize));
        let step = CONTROL.difference * self.candidates.iter().map(size).fold(f64::INFINITY, f64::min);
        let condition = active.conditions[of_node[0].1];
        let (evaluated, rules_gaps) = (condition.evaluation_weight(), condition.rules_gaps());
        for &(_, k) in of_node {
            let contact = &active.contacts[k];
            let weight = contact.stencil().find(|&(n, _)| n == node).map_or(0.0, |(_, weight)| weight);
            // The whole gradient of a gap has the row in it, that of the motion of a row whose nodes stay where they are has not.
            let known = if rules_gaps { -weight } else { 0.0 };
            self.parts[k].push((column, contact.frame.row(0).transpose() * known));
        }
        let map = &given.interval.map;
        let carried = if map.is_static() { 0.0 } else { map.velocity_of_velocity / map.velocity_of_motion };
        let ruled = |contact: &Contact<D>| match condition {
            ContactCondition::Gap | ContactCondition::Massless => contact.gap,
            ContactCondition::Midpoint => contact.relative(|n| motion[n])[0],
            ContactCondition::Endpoint => {
                contact.relative(|n| motion[n] + given.state.velocity[n] * carried)[0]
            }
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
                for (&(_, k), moved) in of_node.iter().zip(&mut self.moved) {
                    if let Some((_, part)) = self.parts[k].last_mut() {
                        part[component] += ruled(moved) * share;
                    }
                    let r = active.acting(k);
                    if r == Vector::<D>::zeros() {
                        continue;
                    }
                    moved.carry_frame(&active.contacts[k].frame);
                    let force = moved.frame.tr_mul(&(r * -share));
                    for (n, weight) in moved.stencil().filter(|&(n, _)| places[n] != NONE) {
                        let mut block = Matrix::<D>::zeros();
                        block.set_column(component, &(force * weight));
                        stiffness.add((places[n] as usize, column as usize), block);
                    }
                }
            }
        }
    }
}
