//! The books of a step of a reduced body.

use carom_mesh::Vector;

use super::place::Rates;
use super::{ReducedBody, part};
use crate::body::rigid::equation::End;
use crate::body::rigid::shape::Wrench;
use crate::body::{BodyEnd, Guess};
use crate::ledger::{BodyLedger, Energies};

impl<const D: usize> ReducedBody<D> {
    /// Completes the state at the end of a step.
    pub(super) fn close(&mut self, guess: &Guess<'_, D>, end: BodyEnd<'_, D>) -> (BodyLedger, Energies) {
        let weight = self.weight();
        let Self { body, equation, moved, forces, reached, scratch, .. } = self;
        let own = part(body);
        let mut contact = Wrench::default();
        forces.restart(Wrench::default());
        for &node in body.body.surface().nodes() {
            forces.add(node, &end.mean_contact_force[node as usize]);
        }
        for &node in &forces.pressed {
            let arm = equation.mean_arm(own, &moved.stretch, node as usize);
            contact.add(&arm, &super::lift(&forces.at[node as usize]));
        }
        equation.force_on_amplitudes(own, forces, &moved.rigid, scratch);
        let pressed: f64 = scratch.iter().zip(&moved.stretch).map(|(g, d)| g * d).sum();
        let mean = moved.rigid.mean_rotation(&equation.place.pose);
        let work = |wrench: &Wrench| {
            wrench.force.dot(&moved.rigid.shift) + wrench.moment_at(&mean).dot(&moved.rigid.turn)
        };
        let End { twist, .. } = equation.rigid.end(&(weight + contact), reached.pose);
        let (turned, before) = (reached.pose.rotation, equation.place.pose.rotation);
        let jump = twist.velocity - equation.rigid.twist.velocity;
        let gained = turned.tr_mul(&twist.spin) - before.tr_mul(&equation.rigid.twist.spin);
        let of_rigid = own.shape.mass * jump.norm_squared() + gained.dot(&(own.shape.inertia * gained));
        equation.end_rates(&moved.stretch, scratch);
        let [viscous, of_vibrations] = equation.taken(own, &moved.stretch, scratch);
        let rates = Rates { twist, amplitudes: std::mem::take(scratch) };
        let energies = own.energies(reached, &rates);
        for node in own.moved.iter().map(|&n| n as usize) {
            end.internal_force[node] = Vector::zeros();
            end.velocity[node] = own.velocity(reached, &rates, node);
        }
        *scratch = rates.amplitudes;
        let ledger = BodyLedger {
            kinetic: energies.kinetic - guess.start.energies.kinetic,
            strain: energies.strain - guess.start.energies.strain,
            external: work(&weight),
            viscous,
            scheme: equation.rigid.map.kinetic_dissipation * of_rigid + of_vibrations,
            contact: work(&contact) + pressed,
            ..BodyLedger::default()
        };
        (ledger, energies)
    }
}
