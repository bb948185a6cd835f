//! A rigid body in a load step: it has no stiffness, and balances by what touches it.

use carom_mesh::{Matrix, Vector};

use super::pose::{Displaced, cayley, inverse_on, lower, on};
use super::shape::Wrench;
use super::{RigidBody, part};
use crate::body::{BodyEnd, Guess, Tangent};
use crate::ledger::{BodyLedger, Energies};

/// The least share of the stiffness of the bodies around it that holds corrections back. Where contacts hold the body, that much is left
/// of an error by every iteration; ten times less costs a digit of the contact problem.
const LEAST: f64 = 1e-2;

impl<const D: usize> RigidBody<D> {
    /// Makes K̄: what holds corrections back is all that there is.
    pub(super) fn hold_back(&mut self, guess: &Guess<'_, D>, tangent: &Tangent<'_, D>) {
        self.start = part(&self.body).shape.pose(guess.start.displacement);
        self.take(guess);
        let external = self.external(guess, 1.0);
        let part = part(&self.body);
        let size = self.body.body.mesh().diameter();
        // Where all is rigid any stiffness will do that makes motions of the order of the body.
        let scale = match part.surroundings {
            surroundings if surroundings > 0.0 => surroundings,
            _ if external.force.norm() > 0.0 => external.force.norm() / size,
            _ => 1.0,
        };
        let stiffness = tangent.held_back.max(LEAST * tangent.grip) * scale;
        let [along, about] = part.free();
        let shift = Vector::<3>::from_fn(|i, _| if along[i] { 1.0 / stiffness } else { 0.0 });
        let turning = Matrix::<3>::from_diagonal_element(stiffness * 0.25 * size * size);
        self.compliance = [Matrix::from_diagonal(&shift), inverse_on(&about, &turning)];
        self.arms_in = self.moved.from(&self.start).rotation;
        self.generation += 1;
    }

    /// The motion that K̄ makes of the forces known so far.
    pub(super) fn balanced(&self) -> Displaced {
        let [shift, turn] = &self.compliance;
        let reached = self.moved.from(&self.start);
        let mut end = reached;
        end.shift += shift * self.wrench.force;
        end.rotation = cayley(&(turn * self.wrench.moment_at(&reached.rotation))) * end.rotation;
        Displaced::between(&self.start, &end)
    }

    /// Completes the state at the end of a load step. Its books are those of path work, by the mean of the step; `scheme` is what that lacks of
    /// balance.
    pub(super) fn end_load_step(
        &mut self,
        guess: &Guess<'_, D>,
        end: BodyEnd<'_, D>,
    ) -> (BodyLedger, Energies) {
        let [along, about] = part(&self.body).free();
        let at_end = self.external(guess, 1.0);
        let pressed = self.part().shape.gather(end.contact_force);
        if let Some(guide) = &self.part().guide {
            let force = pressed.force + at_end.force;
            let guided = Vector::<3>::from_fn(|i, _| if along[i] { 0.0 } else { -force[i] });
            end.support[guide.number] += lower::<D>(&guided);
        }
        let external = self.external(guess, 0.5);
        let contact = self.free_part(end.mean_contact_force);
        let all: Wrench = external + contact;
        let moment = all.moment_at(&self.moved.mean_rotation(&self.start));
        let Displaced { shift, turn } = self.moved;
        let left = on(&along, &all.force).dot(&shift) + on(&about, &moment).dot(&turn);
        end.velocity.fill(Vector::zeros());
        let kinetic = guess.start.energies.kinetic;
        let is_guided = part(&self.body).guide.is_some();
        let ledger = BodyLedger {
            kinetic: -kinetic,
            external: self.work(&external, &self.moved),
            prescribed: if is_guided { left - self.work(&all, &self.moved) } else { 0.0 },
            scheme: left + kinetic,
            contact: self.work(&contact, &self.moved),
            ..BodyLedger::default()
        };
        (ledger, Energies::default())
    }
}
