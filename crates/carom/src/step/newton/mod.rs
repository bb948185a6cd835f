//! How Newton's iterations go on and end.

pub(super) mod acceleration;
mod control;
pub(super) mod convergence;

use carom_mesh::Vector;

use self::acceleration::Acceleration;
use self::convergence::BodyProgress;
use crate::model::assembly::Assembly;

/// The iterations of a step.
#[derive(Debug)]
pub(crate) struct Newton<const D: usize> {
    /// Residuals [N] of all nodes and obstacles.
    pub residual: Vec<Vector<D>>,
    /// The last correction of d [m].
    pub correction: Vec<Vector<D>>,
    pub progress: Vec<BodyProgress>,
    pub acceleration: Acceleration<D>,
    /// The bodies that contacts act on.
    pub in_contact: Vec<usize>,
}

impl<const D: usize> Newton<D> {
    /// Of an assembly.
    pub fn new(assembly: &Assembly<D>) -> Self {
        let zeros = vec![Vector::zeros(); assembly.reference.len()];
        Self {
            acceleration: Acceleration::new(zeros.len(), assembly.body_count()),
            residual: zeros.clone(),
            correction: zeros,
            progress: vec![BodyProgress::new(0.0, false); assembly.body_count()],
            in_contact: Vec::with_capacity(assembly.body_count()),
        }
    }
}
