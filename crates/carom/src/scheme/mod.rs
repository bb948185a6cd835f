//! What a time scheme says about a step: how the new velocity follows from the displacement, and how forces are weighted.
//! The solver never learns the name of the scheme.

mod conserving;
mod quasi_static;
mod step_map;
mod theta;

use serde::{Deserialize, Serialize};

pub use self::step_map::{StepMap, StressRule};

/// A time scheme and its parameters, as the case file names them.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(tag = "kind", rename_all = "kebab-case")]
pub enum Scheme {
    /// The paper's first-order scheme.
    Theta {
        /// θ in (0, 1]: weight of the new velocity in the displacement.
        theta: f64,
        /// ξ in [0, 1]: weight of the new forces in the balance.
        xi: f64,
    },
    /// The energy–momentum scheme.
    Conserving,
    /// Load stepping without inertia: that of every static analysis, which names no scheme.
    #[serde(skip)]
    Static,
}

impl Scheme {
    /// The map of a step of length `dt` [s].
    #[must_use]
    pub fn step_map(&self, dt: f64) -> StepMap {
        match *self {
            Scheme::Theta { theta, xi } => theta::step_map(theta, xi, dt),
            Scheme::Conserving => conserving::step_map(dt),
            Scheme::Static => quasi_static::step_map(dt),
        }
    }
}
