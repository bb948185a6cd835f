//! Closed forms for blocks of 1 × 1, 2 × 2 and 3 × 3 numbers.

use crate::Matrix;

/// The inverse, or None where the determinant is zero or not a number.
#[inline]
pub(crate) fn inverse<const D: usize>(m: &Matrix<D>) -> Option<Matrix<D>> {
    let mut inverse = Matrix::zeros();
    let determinant = match D {
        1 => {
            inverse[(0, 0)] = 1.0;
            m[(0, 0)]
        }
        2 => {
            inverse[(0, 0)] = m[(1, 1)];
            inverse[(0, 1)] = -m[(0, 1)];
            inverse[(1, 0)] = -m[(1, 0)];
            inverse[(1, 1)] = m[(0, 0)];
            m[(0, 0)] * m[(1, 1)] - m[(0, 1)] * m[(1, 0)]
        }
        3 => {
            for i in 0..3 {
                let (i1, i2) = ((i + 1) % 3, (i + 2) % 3);
                for j in 0..3 {
                    let (j1, j2) = ((j + 1) % 3, (j + 2) % 3);
                    inverse[(j, i)] = m[(i1, j1)] * m[(i2, j2)] - m[(i1, j2)] * m[(i2, j1)];
                }
            }
            m[(0, 0)] * inverse[(0, 0)] + m[(0, 1)] * inverse[(1, 0)] + m[(0, 2)] * inverse[(2, 0)]
        }
        _ => unreachable!("a contact vector has one, two or three components"),
    };
    (determinant != 0.0 && determinant.is_finite()).then(|| inverse / determinant)
}

/// Largest eigenvalue of a symmetric matrix: closed forms in 1D and 2D, in 3D that of Smith (1961).
pub(crate) fn largest_eigenvalue<const D: usize>(m: &Matrix<D>) -> f64 {
    match D {
        1 => m[(0, 0)],
        2 => {
            let (mean, half) = (0.5 * (m[(0, 0)] + m[(1, 1)]), 0.5 * (m[(0, 0)] - m[(1, 1)]));
            mean + half.hypot(0.5 * (m[(0, 1)] + m[(1, 0)]))
        }
        3 => {
            let mean = m.trace() / 3.0;
            let shifted = (m + m.transpose()) * 0.5 - Matrix::identity() * mean;
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

    #[test]
    fn inverse_times_matrix_is_the_identity() {
        let m = Matrix::<3>::new(4.0, -1.0, 0.5, 2.0, 3.0, -1.0, 0.3, 1.0, 5.0);
        assert!((inverse(&m).expect("regular") * m - Matrix::identity()).norm() < 1e-15);
        let m = Matrix::<2>::new(4.0, -1.0, 0.5, 2.0);
        assert!((inverse(&m).expect("regular") * m - Matrix::identity()).norm() < 1e-15);
        assert_eq!(inverse(&Matrix::<2>::from_element(1.0)), None);
    }

    #[test]
    fn largest_eigenvalue_agrees_with_known_spectra() {
        assert!((largest_eigenvalue(&Matrix::<2>::new(2.0, 1.0, 1.0, 2.0)) - 3.0).abs() < 1e-15);
        let m = Matrix::<3>::new(2.0, -1.0, 0.0, -1.0, 2.0, -1.0, 0.0, -1.0, 2.0);
        assert!((largest_eigenvalue(&m) - (2.0 + 2.0_f64.sqrt())).abs() < 1e-14);
        assert!((largest_eigenvalue(&Matrix::<3>::identity()) - 1.0).abs() < 1e-15);
    }
}
