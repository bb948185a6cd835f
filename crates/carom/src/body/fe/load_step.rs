//! The books of a load step.

use carom_mesh::nodal;

use super::FeBody;
use super::equation::Equation;
use crate::body::{BodyEnd, Guess};
use crate::ledger::{BodyLedger, Energies};

impl<const D: usize> FeBody<D> {
    /// Completes the state at the end of a load step. Its books are those of path work: of loads and normal reactions in the mean of the step, and of
    /// the force whose work is the change of the strain energy. `scheme` is what the mean lacks of balance inside the body, of third order
    /// in the step where nothing slides.
    pub(super) fn end_load_step(
        &mut self,
        guess: &Guess<'_, D>,
        end: BodyEnd<'_, D>,
    ) -> (BodyLedger, Energies) {
        self.drive.load(&self.part, guess);
        if !self.part.body.held().is_empty() {
            self.close_supports(guess, None, end.contact_force, end.support);
        }
        self.drive.load_at(&self.part, guess, 0.5);
        let Self { part, pose, drive, scratch, momentum, .. } = self;
        let equation = Equation::new(part, guess, pose, drive);
        equation.end_velocity(end.velocity);
        equation.with_history.internal_force(guess.displacement, end.internal_force);
        let plastic = equation.with_history.update(guess.displacement, end.history);
        let (body, held) = (&part.body, part.body.held());
        let [before, after] = part.growth_of(guess.interval);
        let strain = body.after(end.history).grown(after).strain_energy(guess.displacement);
        let (external, viscous) = equation.external_and_viscous_work(scratch);
        let lacking = momentum;
        equation.path_residual(0.5 * (before + after), scratch, lacking);
        let contact = held.free_dot(guess.motion, end.mean_contact_force);
        let inside = held.free_dot(guess.motion, lacking);
        // A bridge may leave motion, which ends here.
        let kinetic = guess.start.energies.kinetic;
        let ledger = BodyLedger {
            kinetic: -kinetic,
            strain: strain - guess.start.energies.strain,
            external,
            prescribed: part.work_of_growth(guess) + inside - nodal::dot(guess.motion, lacking),
            viscous,
            plastic,
            scheme: inside + contact + kinetic,
            contact,
            connections: 0.0,
        };
        (ledger, Energies { strain, ..Energies::default() })
    }
}
