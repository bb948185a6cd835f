//! The energy of a reduced body, by the vibrations that it steps by.

use carom_mesh::Vector;

use super::part::ReducedPart;

/// How a reduced body vibrates, and the energy of what it does besides.
#[derive(Debug, Clone, PartialEq)]
pub struct VibrationEnergies {
    /// ω [rad/s] of every vibration, ascending.
    pub frequencies: Vec<f64>,
    /// ½ η̇² of each [J].
    pub kinetic: Vec<f64>,
    /// ½ ω² η² of each [J].
    pub strain: Vec<f64>,
    /// Kinetic energy of translation and rotation [J].
    pub rigid: f64,
}

impl<const D: usize> ReducedPart<D> {
    /// Its vibrations at these displacements [m] and velocities [m/s] of all its nodes.
    pub fn vibrations(&self, u: &[Vector<D>], v: &[Vector<D>]) -> VibrationEnergies {
        let (place, rates) = self.seen(u, v);
        let stiffness = self.reduction.stiffness();
        let stored = place.amplitudes.iter().zip(stiffness);
        VibrationEnergies {
            frequencies: stiffness.iter().map(|k| k.sqrt()).collect(),
            kinetic: rates.amplitudes.iter().map(|rate| 0.5 * rate * rate).collect(),
            strain: stored.map(|(a, k)| 0.5 * k * a * a).collect(),
            rigid: self.shape.kinetic(&place.pose, &rates.twist),
        }
    }
}
