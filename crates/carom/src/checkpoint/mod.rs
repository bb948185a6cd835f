//! A run as plain arrays, and back: it then goes on as if it had never stopped, to the last bit.
//!
//! What is kept is listed once, in functions that either record or replay a [`Tape`]: `state.rs` the state, `progress.rs` the books and
//! whatever else a run gathers, `factors.rs` what makes a [`Workspace`](crate::Workspace) more than scratch. A kept factor decides to
//! which last digits iterations converge; its values are made again from where it was made, which takes less room than they do.

mod factors;
mod progress;
mod state;
mod tape;

use std::collections::BTreeMap;

use thiserror::Error;

use self::tape::Tape;
use crate::Simulation;

/// A run at one moment, as named arrays.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Checkpoint {
    /// Arrays of numbers, in the units of what they hold.
    pub numbers: BTreeMap<String, Vec<f64>>,
    /// Arrays of counts, indices and flags.
    pub integers: BTreeMap<String, Vec<u64>>,
}

impl Checkpoint {
    /// Version of what is kept and of its names.
    pub const SCHEMA: u64 = 4;
}

/// Why a run cannot be a checkpoint, or a checkpoint not the run.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error("{array}: {what}")]
pub struct CheckpointError {
    /// Name of the array.
    pub array: String,
    /// What is wrong with it.
    pub what: String,
}

impl CheckpointError {
    fn new(array: &str, what: impl Into<String>) -> Self {
        Self { array: array.to_string(), what: what.into() }
    }
}

impl<const D: usize> Simulation<D> {
    /// All that it takes to go on from here. Changes nothing.
    ///
    /// # Errors
    /// If a number is not finite.
    pub fn checkpoint(&mut self) -> Result<Checkpoint, CheckpointError> {
        let mut checkpoint = Checkpoint::default();
        self.exchange(&mut Tape::Record(&mut checkpoint))?;
        Ok(checkpoint)
    }

    /// Goes on where a simulation of the same scenario made its `checkpoint`: every number after is that of a run that never stopped.
    ///
    /// # Errors
    /// If the checkpoint does not fit: an array is missing, has another length, or holds what cannot be. The simulation is then of no
    /// use until another checkpoint is restored.
    pub fn restore(&mut self, checkpoint: &Checkpoint) -> Result<(), CheckpointError> {
        self.exchange(&mut Tape::Replay(checkpoint))?;
        self.spare.clone_from(&self.state);
        self.last_step = None;
        Ok(())
    }

    fn exchange(&mut self, tape: &mut Tape<'_>) -> Result<(), CheckpointError> {
        let mut schema = Checkpoint::SCHEMA;
        tape.integers("schema", [&mut schema])?;
        if schema != Checkpoint::SCHEMA {
            let what = format!("is {schema}, this version reads {}", Checkpoint::SCHEMA);
            return Err(CheckpointError::new("schema", what));
        }
        state::exchange(tape, &self.model, &mut self.state)?;
        progress::exchange(tape, self)?;
        factors::exchange(tape, &self.model, &self.method, &mut self.work)
    }
}
