use crate::{BlockMatrix, Vector};

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

    /// The step ρ_i = 1/λ_max(W_ii) [N/m] of the bi-potential fixed point; 0 for a contact that nothing can move.
    #[must_use]
    pub fn step_length(&self, i: usize) -> f64 {
        let largest = largest_eigenvalue(self.w.diagonal(i));
        if largest > 0.0 { 1.0 / largest } else { 0.0 }
    }
}

/// Largest eigenvalue of a symmetric matrix: closed forms in 1D and 2D, in 3D that of Smith (1961).
fn largest_eigenvalue<const D: usize>(m: &crate::Matrix<D>) -> f64 {
    match D {
        1 => m[(0, 0)],
        2 => {
            let (mean, half) = (0.5 * (m[(0, 0)] + m[(1, 1)]), 0.5 * (m[(0, 0)] - m[(1, 1)]));
            mean + half.hypot(0.5 * (m[(0, 1)] + m[(1, 0)]))
        }
        3 => {
            let mean = m.trace() / 3.0;
            let shifted = (m + m.transpose()) * 0.5 - crate::Matrix::identity() * mean;
            let p = (shifted.norm_squared() / 6.0).sqrt();
            if p == 0.0 {
                return mean;
            }
            let s = shifted / p;
            let det = s[(0, 0)] * (s[(1, 1)] * s[(2, 2)] - s[(1, 2)] * s[(2, 1)])
                - s[(0, 1)] * (s[(1, 0)] * s[(2, 2)] - s[(1, 2)] * s[(2, 0)])
                + s[(0, 2)] * (s[(1, 0)] * s[(2, 1)] - s[(1, 1)] * s[(2, 0)]);
            mean + 2.0 * p * ((det / 2.0).clamp(-1.0, 1.0).acos() / 3.0).cos()
        }
        _ => unreachable!("a contact vector has one, two or three components"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Matrix;

    #[test]
    fn largest_eigenvalue_agrees_with_known_spectra() {
        assert!((largest_eigenvalue(&Matrix::<2>::new(2.0, 1.0, 1.0, 2.0)) - 3.0).abs() < 1e-15);
        let m = Matrix::<3>::new(2.0, -1.0, 0.0, -1.0, 2.0, -1.0, 0.0, -1.0, 2.0);
        assert!((largest_eigenvalue(&m) - (2.0 + 2.0_f64.sqrt())).abs() < 1e-14);
        assert!((largest_eigenvalue(&Matrix::<3>::identity()) - 1.0).abs() < 1e-15);
    }
}
