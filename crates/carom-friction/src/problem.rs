use crate::{BlockMatrix, Vector, cone, small};

/// Find r and w = W r + q that obey Signorini's and Coulomb's laws.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct ContactProblem<const D: usize> {
    /// Delassus operator W [m/N]: symmetric, positive semidefinite.
    pub w: BlockMatrix<D>,
    /// Relative motion without reactions [m].
    pub q: Vec<Vector<D>>,
    /// Friction coefficient of every contact.
    pub mu: Vec<f64>,
}

impl<const D: usize> ContactProblem<D> {
    /// Number of contacts.
    #[must_use]
    pub fn len(&self) -> usize {
        self.q.len()
    }

    /// Whether there is no contact at all.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.q.is_empty()
    }

    /// The relative motion w_i = (W r + q)_i of contact `i` [m].
    #[inline]
    #[must_use]
    pub fn motion(&self, i: usize, r: &[Vector<D>]) -> Vector<D> {
        self.q[i] + self.w.row_times(i, r)
    }

    /// The natural unit of stiffness n D / tr W [N/m]: the inverse of the mean compliance; 1 where nothing can move.
    #[must_use]
    pub fn natural_stiffness(&self) -> f64 {
        let trace: f64 = (0..self.len()).map(|i| self.w.diagonal(i).trace()).sum();
        if trace > 0.0 { (self.len() * D) as f64 / trace } else { 1.0 }
    }

    /// The step ρ_i = 1/λ_max(W_ii) [N/m] of the bi-potential fixed point; 0 for a contact that nothing can move.
    #[must_use]
    pub fn step_length(&self, i: usize) -> f64 {
        let largest = small::largest_eigenvalue(self.w.diagonal(i));
        // What is so stiff that its inverse overflows counts as what nothing can move.
        if largest > 0.0 && (1.0 / largest).is_finite() { 1.0 / largest } else { 0.0 }
    }

    /// The step ρ_i of every contact [N/m].
    pub(crate) fn step_lengths(&self) -> Vec<f64> {
        (0..self.len()).map(|i| self.step_length(i)).collect()
    }

    /// Brings reactions into the cones; no reaction helps a contact that nothing can move, whose ρ_i is 0.
    pub(crate) fn bring_into_cones(&self, rho: impl Iterator<Item = f64>, r: &mut [Vector<D>]) {
        for ((r, rho), &mu) in r.iter_mut().zip(rho).zip(&self.mu) {
            *r = if rho > 0.0 { cone::project(r, mu) } else { Vector::zeros() };
        }
    }
}
