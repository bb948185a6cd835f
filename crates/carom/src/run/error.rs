use thiserror::Error;

use super::crushed::Crushed;
use crate::error::StepError;

/// Why a run stopped early.
#[derive(Debug, Clone, PartialEq, Error)]
#[error(
    "step at t = {time:.9} s failed with a length of {time_step:.3e} s, after {halvings} halving{}: {reason}{}",
    if *halvings == 1 { "" } else { "s" },
    crushed.as_ref().map_or_else(String::new, |crushed| format!("; it starts with {crushed}"))
)]
pub struct RunError {
    /// Start of the step that failed [s].
    pub time: f64,
    /// Shortest step tried [s].
    pub time_step: f64,
    /// How often the step was halved.
    pub halvings: u32,
    /// Why the shortest one failed.
    pub reason: StepError,
    /// What may be behind that: cells that are crushed at the start of the step.
    pub crushed: Option<Box<Crushed>>,
}
