//! A run as plain arrays, and back: it then goes on as if it had never stopped, to the last bit.
//!
//! What is kept is listed once, in functions that either record or replay an [`Archive`]. `state.rs` has the state, `progress.rs` the books
//! and whatever else a run gathers, `factors.rs` what makes a [`Workspace`](crate::Workspace) more than scratch. A kept factor decides to
//! which last digits iterations converge; its values are made again from where it was made, which takes less room than they do.

mod factors;
mod progress;
mod state;

use crate::Simulation;
use crate::archive::{Archive, Checkpoint, CheckpointError};

impl<const D: usize> Simulation<D> {
    /// All that it takes to go on from here. Changes nothing.
    ///
    /// # Errors
    /// If a number is not finite.
    pub fn checkpoint(&mut self) -> Result<Checkpoint, CheckpointError> {
        let mut checkpoint = Checkpoint::default();
        self.exchange(&mut Archive::Record(&mut checkpoint))?;
        Ok(checkpoint)
    }

    /// Goes on where a simulation of the same scenario made its `checkpoint`: every number after is that of a run that never stopped.
    ///
    /// # Errors
    /// If the checkpoint does not fit: an array is missing, has another length, or holds what cannot be. The simulation is then of no
    /// use until another checkpoint is restored.
    pub fn restore(&mut self, checkpoint: &Checkpoint) -> Result<(), CheckpointError> {
        self.exchange(&mut Archive::Replay(checkpoint))?;
        self.spare.clone_from(&self.state);
        self.last_step = None;
        Ok(())
    }

    fn exchange(&mut self, archive: &mut Archive<'_>) -> Result<(), CheckpointError> {
        let mut schema = Checkpoint::SCHEMA;
        archive.integers("schema", [&mut schema])?;
        if schema != Checkpoint::SCHEMA {
            let what = format!("is {schema}, this version reads {}", Checkpoint::SCHEMA);
            return Err(CheckpointError::new("schema", what));
        }
        state::exchange(archive, &self.model.assembly, &mut self.state)?;
        progress::exchange(archive, self)?;
        factors::exchange(archive, &self.method, &mut self.work)
    }
}
