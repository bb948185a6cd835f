//! A state on its way through time, and a nominal step of it.

use super::error::RunError;
use crate::error::StepError;
use crate::run::crushed::CrushedCells;
use crate::step::workspace::Workspace;
use crate::{Method, Model, State};

/// A nominal step: one of the time grid.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Nominal {
    /// When it ends [s].
    pub end: f64,
    /// Its length [s].
    pub dt: f64,
    /// The largest energy of the model so far [J].
    pub energy: f64,
}

/// A state on its way through time.
pub(crate) struct Stepper<'a, const D: usize> {
    pub model: &'a Model<D>,
    pub method: &'a Method<D>,
    pub state: &'a mut State<D>,
    /// Scratch of the same size.
    pub spare: &'a mut State<D>,
    pub work: &'a mut Workspace<D>,
    /// How often the steps of a static analysis are halved at present.
    pub halvings: &'a mut u32,
    /// Substeps that failed.
    pub failed: u64,
}

impl<const D: usize> Stepper<'_, D> {
    /// Why the run ends here, with a step of this `length` [s] after so many `halvings`.
    pub fn error(&self, length: f64, halvings: u32, reason: StepError) -> RunError {
        RunError {
            time: self.state.time,
            time_step: length,
            halvings,
            reason,
            crushed: CrushedCells::find(self.model, self.state, |_| true)
                .map(|cells| Box::new(cells.of(self.model))),
        }
    }
}
