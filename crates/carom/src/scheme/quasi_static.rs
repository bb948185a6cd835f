use super::step_map::{STEADYING, StepMap, StressRule};

/// No inertia: the forces balance at the end of the step (ξ = 1), and time only says how far loads and supports have come.
///
/// Its books are those of the mean of the step, as path work is: see `Equation::path_residual`.
pub(super) fn step_map(dt: f64) -> StepMap {
    StepMap {
        dt,
        velocity_of_velocity: 0.0,
        velocity_of_motion: 0.0,
        xi: 1.0,
        stress: StressRule::Weighted,
        kinetic_dissipation: 0.0,
        strain_dissipation: 0.0,
        steadying: STEADYING,
    }
}
