//! The books of a step of a rigid body.

use carom_mesh::Vector;

use super::equation::{End, Equation};
use super::pose::{Displaced, Pose, lower, on};
use super::{RigidBody, part};
use crate::body::{BodyEnd, Guess};
use crate::ledger::{BodyLedger, Energies};

impl<const D: usize> RigidBody<D> {
    /// Completes the state at the end of a step in time: momenta change by the impulse of all forces.
    pub(super) fn end_in_time(
        &mut self,
        equation: &Equation,
        guess: &Guess<'_, D>,
        end: BodyEnd<'_, D>,
    ) -> (BodyLedger, Energies) {
        let map = &guess.interval.map;
        let external = self.external(guess, map.xi);
        let contact = self.free_part(end.mean_contact_force);
        let shape = &part(&self.body).shape;
        let pose = shape.pose(guess.displacement);
        let done = equation.end(&(external + contact), pose);
        shape.velocities(&pose, &done.twist, end.velocity);
        let kinetic = shape.kinetic(&pose, &done.twist);
        let [scheme, mut prescribed] = self.taken_by_scheme(equation, &pose, &done);
        if let Some(guide) = &part(&self.body).guide {
            let Displaced { shift, turn } = self.moved;
            prescribed += (done.impulse.dot(&shift) + done.moment.dot(&turn)) / map.dt;
            let pressed = shape.gather(end.mean_contact_force).force - contact.force;
            end.support[guide.number] += lower::<D>(&(done.impulse / map.dt - pressed));
        }
        let ledger = BodyLedger {
            kinetic: kinetic - guess.start.energies.kinetic,
            external: self.work(&external, &self.moved),
            prescribed,
            scheme,
            contact: self.work(&contact, &self.moved),
            ..BodyLedger::default()
        };
        (ledger, Energies { kinetic, ..Energies::default() })
    }

    /// What the scheme takes of the free motion [J], and what guides do where the motion at the end is not what the scheme makes of the step:
    /// m Δv·(½(v + v₊) − d/Δt), and likewise of turns.
    fn taken_by_scheme(&self, equation: &Equation, pose: &Pose, done: &End) -> [f64; 2] {
        let shape = &part(&self.body).shape;
        let dt = equation.map.dt;
        let beside = |v0: &Vector<3>, v1: &Vector<3>, d: &Vector<3>| (v0 + v1) * 0.5 - d / dt;
        let (v0, v1) = (&equation.twist.velocity, &done.twist.velocity);
        let jump = v1 - v0;
        let mut scheme = shape.mass * on(&equation.moves_along, &jump).norm_squared();
        let guided = std::array::from_fn(|i| shape.moves_along[i] && !equation.moves_along[i]);
        let mut driven = shape.mass * on(&guided, &jump).dot(&beside(v0, v1, &self.moved.shift));
        let own = |pose: &Pose, spin: &Vector<3>| pose.rotation.tr_mul(spin);
        let (before, after) = (own(&self.start, &equation.twist.spin), own(pose, &done.twist.spin));
        let gained = shape.inertia * (after - before);
        if equation.turns_about == shape.turns_about {
            scheme += gained.dot(&(after - before));
        } else {
            driven += gained.dot(&beside(&before, &after, &own(&self.start, &self.moved.turn)));
        }
        [equation.map.kinetic_dissipation * scheme, driven]
    }
}
