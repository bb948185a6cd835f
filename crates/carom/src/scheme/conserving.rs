use super::step_map::{StepMap, StressRule};
use super::theta;

/// The energy–momentum scheme: the paper's relations with θ = ½, and a stress whose work over the step is exactly the change of
/// stored energy (Simo & Tarnow 1992; Gonzalez 2000). It dissipates nothing.
pub(super) fn step_map(dt: f64) -> StepMap {
    StepMap { stress: StressRule::Conserving, ..theta::step_map(0.5, 0.5, dt) }
}
