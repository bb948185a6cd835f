//! A run as plain arrays, and back: it then goes on as if it had never stopped, to the last bit.
//!
//! What is kept is listed once, in functions that either record or replay an [`Archive`]. `state.rs` has the state, `progress.rs` the books
//! and whatever else a run gathers, `factors.rs` what makes a [`Workspace`](crate::Workspace) more than scratch. A kept factor decides to
//! which last digits iterations converge; its values are made again from where it was made, which takes less room than they do.

mod factors;
mod progress;
mod state;

use carom_mesh::Vector;
use carom_mesh::compiled;

use crate::Simulation;
use crate::archive::{Archive, Checkpoint, CheckpointError};

type ExchangeAll<const D: usize> = fn(&mut Simulation<D>, &mut Archive<'_>) -> Result<(), CheckpointError>;

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

    /// Starts from the state that a run of the same bodies, obstacles and pairs ended in, which is in a `checkpoint` of it. The books begin anew, and
    /// what is prescribed counts from there.
    ///
    /// # Errors
    /// If the state does not fit, or is of another time than the run starts at. The simulation is then of no use until another is given.
    ///
    /// # Panics
    /// If steps were made already.
    pub fn start_from(&mut self, checkpoint: &Checkpoint) -> Result<(), CheckpointError> {
        assert_eq!(self.step(), 0, "a state to start from belongs before the first step");
        let mut archive = Archive::Replay(checkpoint);
        schema(&mut archive)?;
        let Self { state, stages, grid, .. } = self;
        state.support.resize(archive.rows("state/support", 0)? / D, Vector::zeros());
        state::exchange(&mut archive, &stages[0].model.assembly, state)?;
        if state.time != grid.start_time {
            let what = format!("is {} s, where the run starts at {} s", state.time, grid.start_time);
            return Err(CheckpointError::new("state/time", what));
        }
        state.friction_energy.fill(0.0);
        state.slip.fill(0.0);
        stages[0].begin(state);
        self.restart();
        Ok(())
    }

    fn exchange(&mut self, archive: &mut Archive<'_>) -> Result<(), CheckpointError> {
        compiled!(D, Simulation::exchange_all as ExchangeAll)(self, archive)
    }

    fn exchange_all(&mut self, archive: &mut Archive<'_>) -> Result<(), CheckpointError> {
        schema(archive)?;
        let mut stage = self.current;
        archive.integers("run/stage", [&mut stage])?;
        if stage >= self.stages.len() {
            return Err(CheckpointError::new("run/stage", "is none of the case"));
        }
        if archive.replays() {
            self.enter(stage);
            self.stages[stage].model.take_over(&mut self.state);
        }
        state::exchange(archive, &self.stages[stage].model.assembly, &mut self.state)?;
        progress::exchange(archive, self)?;
        factors::exchange(archive, &self.stages[stage].method, &mut self.work)
    }
}

/// Records the version of what is kept, or refuses another.
fn schema(archive: &mut Archive<'_>) -> Result<(), CheckpointError> {
    let mut schema = Checkpoint::SCHEMA;
    archive.integers("schema", [&mut schema])?;
    if schema == Checkpoint::SCHEMA {
        return Ok(());
    }
    let what = format!("is {schema}, this version reads {}", Checkpoint::SCHEMA);
    Err(CheckpointError::new("schema", what))
}
