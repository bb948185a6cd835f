use super::step_map::{StepMap, StressRule};

/// No inertia: the forces balance at the end of the step (ξ = 1), and time only says how far loads and supports have come.
///
/// The work of the end forces and the trapezoidal mean differ by ½ d·(f₊ − f), which the ledger has as `scheme`; what the mean
/// differs from the change of stored energy, of third order in the step, is the defect.
pub(super) fn step_map(dt: f64) -> StepMap {
    StepMap {
        dt,
        velocity_of_velocity: 0.0,
        velocity_of_motion: 0.0,
        xi: 1.0,
        stress: StressRule::Weighted,
        kinetic_dissipation: 0.0,
        strain_dissipation: 0.5,
    }
}
