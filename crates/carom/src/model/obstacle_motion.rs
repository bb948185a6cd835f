use carom_mesh::Vector;

use crate::signal::Signal;

/// How a rigid obstacle moves.
#[derive(Debug, Clone, PartialEq)]
pub enum ObstacleMotion<const D: usize> {
    /// At a constant velocity [m/s].
    Velocity(Vector<D>),
    /// By a displacement [m], component by component.
    Displacement(Box<[Signal; D]>),
}

impl<const D: usize> ObstacleMotion<D> {
    /// Velocity [m/s] at time `t` [s].
    #[must_use]
    pub fn velocity(&self, t: f64) -> Vector<D> {
        match self {
            Self::Velocity(v) => *v,
            Self::Displacement(signals) => Vector::from_fn(|i, _| signals[i].at(t).rate),
        }
    }

    /// Whether it is prescribed as a displacement, which no velocity foretells.
    #[must_use]
    pub fn is_prescribed(&self) -> bool {
        matches!(self, Self::Displacement(_))
    }

    /// Motion [m] from the displacement `u` at the start of a step to its end, at time `end` [s] after `dt` [s].
    #[must_use]
    pub fn increment(&self, u: &Vector<D>, end: f64, dt: f64) -> Vector<D> {
        match self {
            Self::Velocity(v) => v * dt,
            // The difference to where it is, so that round-off does not add up.
            Self::Displacement(signals) => Vector::from_fn(|i, _| signals[i].at(end).value - u[i]),
        }
    }
}
