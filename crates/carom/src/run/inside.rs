//! Nodes inside reduced bodies: no step asks for them, and whoever looks at a run does.

use carom_mesh::Vector;

use super::error::RunError;
use super::simulation::{Outcome, Simulation};
use crate::body::reduced::part::ReducedPart;

impl<const D: usize> Simulation<D> {
    /// Runs until time `until` [s] (the end of the run at most), or until `pause`, asked after every step, says so.
    ///
    /// # Errors
    /// If a step fails after all retries; the state is then that after the last good step.
    pub fn advance(&mut self, until: f64, pause: impl FnMut() -> bool) -> Result<Outcome, RunError> {
        let made = self.go_to(until, pause);
        self.complete();
        made
    }

    /// Lets nodes of reduced bodies that steps do not ask for be where they are, after [`Self::go_to`].
    pub fn complete(&mut self) {
        if !std::mem::replace(&mut self.is_complete, true) {
            self.each_reduced(ReducedPart::complete);
        }
    }

    /// Lets those nodes of reduced bodies that are tracked be where they are, and move so.
    pub(super) fn complete_tracked(&mut self) {
        self.each_reduced(ReducedPart::complete_tracked);
    }

    fn each_reduced(&mut self, complete: impl Fn(&ReducedPart<D>, &mut [Vector<D>], &mut [Vector<D>])) {
        for b in self.stages[self.current].model.bodies.iter() {
            let Some(reduced) = &b.reduced else { continue };
            for state in [&mut self.state, &mut self.spare] {
                complete(reduced, &mut state.displacement[b.nodes()], &mut state.velocity[b.nodes()]);
            }
        }
    }
}
