//! Nodes inside reduced bodies: no step asks for them, and whoever looks at a run does.

use super::error::RunError;
use super::simulation::{Outcome, Simulation};

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

    /// Lets nodes inside reduced bodies, which steps do not ask for, be where they are.
    pub(super) fn complete(&mut self) {
        for b in self.stages[self.current].model.bodies.iter() {
            let Some(reduced) = &b.reduced else { continue };
            for state in [&mut self.state, &mut self.spare] {
                reduced.complete(&mut state.displacement[b.nodes()], &mut state.velocity[b.nodes()]);
            }
        }
    }
}
