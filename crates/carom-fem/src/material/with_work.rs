//! Stresses whose work over a step is known beforehand.

use super::Mat3;

/// Below this change of strain the correction of the discrete gradient, of its third order, is smaller than round-off.
const SMALL_STRAIN: f64 = 1e-6;

/// The symmetric stress S̄ [Pa] closest to `stress` with S̄:ΔE = `work`: S̄ = S + [W − S:ΔE] ΔE/|ΔE|² (Gonzalez 2000).
///
/// `change` is ΔE, the change of the Green–Lagrange strain, and `work` [J/m³] is asked for only where it matters.
#[inline]
pub fn with_work(stress: &Mat3, change: &Mat3, work: impl FnOnce() -> f64) -> Mat3 {
    let size = change.norm_squared();
    if size > SMALL_STRAIN * SMALL_STRAIN {
        stress + change * ((work() - stress.dot(change)) / size)
    } else {
        *stress
    }
}
