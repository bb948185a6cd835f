//! How contacts hold together: Coulomb's cone is shifted by their adhesion.
//!
//! The reactions of the reduced problem are in the cone; what acts on bodies is less by the adhesion. So the problem is that of Signorini and Coulomb
//! whatever holds, and no solver knows of it.

use carom_contact::{Candidate, Contact};
use carom_friction::ContactProblem;
use carom_mesh::Vector;

use super::active::ActiveSet;
use super::control::CONTROL;
use crate::model::given::Given;

/// What holds a contact together in a step [N] that is like this at its start, where it `is_closed` or not; none if nothing does.
pub(super) fn adhesion<const D: usize>(
    given: &Given<'_, D>,
    candidate: &Candidate,
    at_start: &Contact<D>,
    is_closed: bool,
) -> Option<f64> {
    let Given { assembly, state, .. } = *given;
    if assembly.cohesions.are_none() {
        return None;
    }
    let known = state.reaction(candidate.key())?;
    let cohesion = assembly.cohesions.of(&assembly.contact.pairs.get(candidate.pair as usize))?;
    if known.adhesion.is_none() && !(cohesion.lasting && is_closed) {
        return None;
    }
    let adhesion = assembly.adhesion(candidate.key(), at_start, &|n| given.position(n))?;
    // What nothing breaks has held so much before.
    Some(adhesion.max(known.adhesion.filter(|_| assembly.is_unbreakable(candidate.pair)).unwrap_or(0.0)))
}

impl<const D: usize> ActiveSet<D> {
    /// What of the reaction of contact `i` acts on its bodies, as the reduced problem has it: less than that is in the cone.
    pub fn acting(&self, i: usize) -> Vector<D> {
        let mut r = self.reactions[i];
        r[0] -= self.adhesions[i].unwrap_or(0.0) * self.weights[i];
        r
    }

    /// What acts of the reactions of all contacts.
    pub fn all_acting(&self) -> impl Iterator<Item = Vector<D>> {
        (0..self.reactions.len()).map(|i| self.acting(i))
    }

    /// Whether contact `i` holds, and nothing breaks it.
    pub fn is_unbreakable(&self, given: &Given<'_, D>, i: usize) -> bool {
        self.adhesions[i].is_some() && given.assembly.is_unbreakable(self.candidates[i].pair)
    }

    /// Looks at where iterations have led, with their last `problem`, whose motions are of this `size` [m]: a contact that has opened has lost its
    /// adhesion, and one that nothing breaks gets so much of it that its reaction is inside the cone. Returns whether that changes anything.
    ///
    /// At the tip of the cone a contact need not open: where many hold a rigid body, some bear all they can.
    pub fn let_go(&mut self, given: &Given<'_, D>, problem: &ContactProblem<D>, size: f64) -> bool {
        let mut has_changed = false;
        for i in 0..self.adhesions.len() {
            let (Some(adhesion), r) = (self.adhesions[i], self.reactions[i]) else { continue };
            let w = problem.motion(i, &self.reactions);
            if !self.is_unbreakable(given, i) {
                if r[0] <= 0.0 && w[0] > CONTROL.opens * size {
                    self.adhesions[i] = None;
                    has_changed = true;
                }
                continue;
            }
            let across = Vector::<D>::from_fn(|k, _| if k == 0 { 0.0 } else { r[k] }).norm();
            let is_inside = across < self.friction[i] * r[0] * (1.0 - CONTROL.sliding);
            let pull = r.norm() + adhesion + w.norm() * problem.step_length(i);
            if !is_inside && pull > 0.0 {
                self.adhesions[i] = Some(adhesion + CONTROL.grip * pull);
                self.reactions[i][0] += CONTROL.grip * pull * self.weights[i];
                has_changed = true;
            }
        }
        has_changed
    }
}
