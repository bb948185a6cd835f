//! Contact problems in the unknowns of the bodies: M v = H r + f, w = Hᵀ v + b.

mod compliance;
mod condense;
mod factor;
mod incidence;
mod inverse;
mod parts;
#[cfg(test)]
mod tests;

use faer::sparse::SparseColMat;

use crate::{ContactProblem, Vector};
use compliance::Compliance;

/// Find r, v and w with M v = H r + f and w = Hᵀ v + b, so that r and w obey Signorini's and Coulomb's laws.
///
/// In any consistent units: v may be velocities and r impulses, or v displacements and r forces.
#[derive(Debug, Clone)]
pub struct GlobalProblem<const D: usize> {
    /// Mass or stiffness matrix M, n_dof × n_dof, regular; symmetric positive definite as a rule.
    pub m: SparseColMat<usize, f64>,
    /// Maps reactions to forces on the unknowns: H, n_dof × n D, the columns of contact i being i D, …, i D + D − 1.
    pub h: SparseColMat<usize, f64>,
    /// Forces on the unknowns, n_dof.
    pub f: Vec<f64>,
    /// Motion of the contacts where the bodies rest, n.
    pub b: Vec<Vector<D>>,
    /// Friction coefficient of every contact, n.
    pub mu: Vec<f64>,
}

/// M has no inverse, or none with a correct digit, at this unknown.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct SingularMatrix {
    /// Index of the unknown.
    pub dof: usize,
}

impl std::fmt::Display for SingularMatrix {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "M is singular, or too close to it to be inverted, at unknown {}", self.dof)
    }
}

impl std::error::Error for SingularMatrix {}

impl<const D: usize> GlobalProblem<D> {
    /// Number of contacts.
    #[must_use]
    pub fn len(&self) -> usize {
        self.b.len()
    }

    /// Whether there is no contact at all.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.b.is_empty()
    }

    /// The same problem in reactions alone: W = Hᵀ M⁻¹ H and q = Hᵀ M⁻¹ f + b.
    ///
    /// Blocks are stored only where two contacts touch unknowns that M couples, directly or through others.
    ///
    /// # Errors
    /// If M is singular.
    pub fn condense(&self) -> Result<ContactProblem<D>, SingularMatrix> {
        Ok(Compliance::new(self)?.condense())
    }
}
