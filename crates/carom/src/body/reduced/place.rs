//! Where a reduced body is, and how it moves.

use carom_mesh::Vector;

use crate::body::rigid::pose::{Pose, Twist};

/// Where a reduced body is: x = c + R (X − C + Φ η).
#[derive(Debug, Clone, PartialEq, Default)]
pub(crate) struct Place {
    pub pose: Pose,
    /// η [m √kg].
    pub amplitudes: Vec<f64>,
}

/// How a reduced body moves.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Rates {
    pub twist: Twist,
    /// dη/dt [m √kg/s].
    pub amplitudes: Vec<f64>,
}

impl Place {
    /// Where it is drawn.
    pub fn of(count: usize) -> Self {
        Self { pose: Pose::default(), amplitudes: vec![0.0; count] }
    }
}

impl Rates {
    /// At rest.
    pub fn of(count: usize) -> Self {
        let twist = Twist { velocity: Vector::zeros(), spin: Vector::zeros() };
        Self { twist, amplitudes: vec![0.0; count] }
    }
}
