use super::step_map::{STEADYING, StepMap, StressRule};

/// The paper's scheme: d = Δt[(1 − θ)v + θ v₊], hence v₊ = (1 − 1/θ)v + d/(θΔt) (4), forces weighted by 1 − ξ and ξ (3).
///
/// Its algebra gives d·M(v₊ − v)/Δt = ΔE_kinetic + (θ − ½)|v₊ − v|²_M and
/// d·[(1 − ξ)f + ξf₊] = ½d·(f + f₊) + (ξ − ½)d·(f₊ − f): what θ, ξ > ½ dissipate.
pub(super) fn step_map(theta: f64, xi: f64, dt: f64) -> StepMap {
    StepMap {
        dt,
        velocity_of_velocity: 1.0 - 1.0 / theta,
        velocity_of_motion: 1.0 / (theta * dt),
        xi,
        stress: StressRule::Weighted,
        kinetic_dissipation: theta - 0.5,
        strain_dissipation: xi - 0.5,
        steadying: STEADYING,
    }
}
