//! How contacts hold together: Coulomb's cone is shifted by their adhesion.
//!
//! The reactions of the reduced problem are in the cone; what acts on bodies is less by the adhesion. So the problem is that of Signorini and Coulomb
//! whatever holds, and no solver knows of it.

use carom_contact::{Contact, Positions};
use carom_friction::ContactProblem;
use carom_mesh::Vector;

use super::active::ActiveSet;
use super::control::CONTROL;

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

    /// Lets these reactions act, with the adhesion that there is now.
    pub fn act(&mut self, acting: &[Vector<D>]) {
        self.reactions.copy_from_slice(acting);
        for ((r, adhesion), weight) in self.reactions.iter_mut().zip(&self.adhesions).zip(&self.weights) {
            r[0] += adhesion.unwrap_or(0.0) * weight;
        }
    }

    /// Whether contact `i` holds, and nothing breaks it.
    pub fn is_bond(&self, i: usize) -> bool {
        self.bonds.binary_search_by_key(&i, |(k, _)| *k).is_ok()
    }

    /// Puts contacts that nothing breaks among `contacts` as they were made, where nodes are at `position`: their stencils do not change, so that what they
    /// tie stays where it was, and no momentum is lost.
    pub fn tie(&self, contacts: &mut [Contact<D>], position: &Positions<'_, D>) {
        for (i, bond) in &self.bonds {
            contacts[*i] = bond.moved(position);
        }
    }

    /// Gives contacts that nothing breaks so much adhesion that their reactions are inside the cone, after a solution of the `problem`, and no more than
    /// they need, as what is in the cone is known to so many digits; `guess` is what bodies know of the reactions. Returns whether some hold by more.
    pub fn hold_on(&mut self, problem: &mut ContactProblem<D>, guess: &mut [Vector<D>]) -> bool {
        self.more.clear();
        let mut has_grown = false;
        for k in 0..self.bonds.len() {
            let i = self.bonds[k].0;
            let (r, stops) = (self.reactions[i], problem.motion(i, &self.reactions) * problem.step_length(i));
            // What is left of the motion must not lead out of the cone: at its tip the solver leaves what is as good as nothing.
            let tried = r - stops;
            let across = Vector::<D>::from_fn(|k, _| if k == 0 { 0.0 } else { tried[k] }).norm();
            let is_inside = across < self.friction[i] * tried[0] * (1.0 - CONTROL.sliding);
            let (pull, acts) = (r.norm() + stops.norm(), self.acting(i));
            let adhesion = r[0] - acts[0];
            if !is_inside && pull > 0.0 {
                has_grown = true;
                self.more.push((i, CONTROL.grip * pull));
            } else if adhesion > CONTROL.grip * CONTROL.grip * acts.norm() && acts.norm() > 0.0 {
                self.more.push((i, CONTROL.grip * acts.norm() - adhesion));
            }
        }
        for &(i, more) in &self.more {
            self.adhesions[i] = self.adhesions[i].map(|adhesion| adhesion + more / self.weights[i]);
            self.reactions[i][0] += more;
            guess[i][0] += more;
            for (j, q) in problem.q.iter_mut().enumerate() {
                if let Some(block) = problem.w.block(j, i) {
                    *q -= block.column(0) * more;
                }
            }
        }
        has_grown
    }

    /// Looks at where iterations have led, with their last `problem`, whose motions are of this `size` [m]: a contact that has opened has lost its
    /// adhesion. Returns whether there are such.
    ///
    /// At the tip of the cone a contact need not open: where many hold a rigid body, some bear all they can.
    pub fn let_go(&mut self, problem: &ContactProblem<D>, size: f64) -> bool {
        let mut has_changed = false;
        for i in 0..self.adhesions.len() {
            let holds = self.adhesions[i].is_some() && !self.is_bond(i);
            if holds && self.reactions[i][0] <= 0.0 {
                let opens = problem.motion(i, &self.reactions)[0] > CONTROL.opens * size;
                has_changed |= opens;
                if opens {
                    self.adhesions[i] = None;
                }
            }
        }
        has_changed
    }
}
