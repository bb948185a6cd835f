//! Closed forms for blocks of 1 × 1, 2 × 2 and 3 × 3 numbers.

use crate::Matrix;
use crate::binary::{exponent, power_of_two};

/// The inverse, or None where the determinant is zero or not a number.
#[inline]
pub(crate) fn inverse<const D: usize>(m: &Matrix<D>) -> Option<Matrix<D>> {
    let (inverse, determinant) = adjugate(m);
    if determinant.is_normal() { Some(inverse / determinant) } else { inverse_of_extreme(m) }
}

/// The inverse of a matrix whose determinant, a product of D numbers, is zero or may have overflowed or lost digits.
#[cold]
fn inverse_of_extreme<const D: usize>(m: &Matrix<D>) -> Option<Matrix<D>> {
    let unit = unit_of(m)?;
    let (inverse, determinant) = adjugate(&(m * unit));
    (determinant != 0.0 && determinant.is_finite()).then(|| inverse / determinant * unit)
}

/// The power of two that brings the largest entry, if there is one, to between 1 and 2, or as near as a number can bring it.
fn unit_of<const D: usize>(m: &Matrix<D>) -> Option<f64> {
    let largest = m.amax();
    (largest > 0.0 && largest.is_finite()).then(|| power_of_two((-exponent(largest)).clamp(-1022, 1023)))
}

/// The adjugate matrix and the determinant.
#[inline]
fn adjugate<const D: usize>(m: &Matrix<D>) -> (Matrix<D>, f64) {
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
    (inverse, determinant)
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
            let Some(unit) = unit_of(m) else { return m.trace() };
            let m = m * unit;
            let mean = m.trace() / 3.0;
            let shifted = (m + m.transpose()) * 0.5 - Matrix::identity() * mean;
            let p = (shifted.norm_squared() / 6.0).sqrt();
            if p == 0.0 {
                return mean / unit;
            }
            let s = shifted / p;
            let det = s[(0, 0)] * (s[(1, 1)] * s[(2, 2)] - s[(1, 2)] * s[(2, 1)])
                - s[(0, 1)] * (s[(1, 0)] * s[(2, 2)] - s[(1, 2)] * s[(2, 0)])
                + s[(0, 2)] * (s[(1, 0)] * s[(2, 1)] - s[(1, 1)] * s[(2, 0)]);
            (mean + 2.0 * p * ((det / 2.0).clamp(-1.0, 1.0).acos() / 3.0).cos()) / unit
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

    /// Powers of two change nothing but the exponent, also where determinants and squares are no numbers any more.
    #[test]
    fn extreme_blocks_are_as_exact_as_others() {
        let m = Matrix::<3>::new(4.0, -1.0, 0.5, -1.0, 3.0, -1.0, 0.5, -1.0, 5.0);
        let plane = m.fixed_view::<2, 2>(0, 0).into_owned();
        for k in [-1000, -700, -350, -120, 120, 350, 700, 1000] {
            let unit = power_of_two(k);
            assert_eq!(largest_eigenvalue(&(m * unit)), largest_eigenvalue(&m) * unit, "2^{k}");
            assert_eq!(largest_eigenvalue(&(plane * unit)), largest_eigenvalue(&plane) * unit, "2^{k}");
            let inverses = (inverse(&(m * unit)).expect("regular"), inverse(&m).expect("regular"));
            assert!((inverses.0 * unit - inverses.1).amax() < 1e-15, "2^{k}");
            let inverses = (inverse(&(plane * unit)).expect("regular"), inverse(&plane).expect("regular"));
            assert!((inverses.0 * unit - inverses.1).amax() < 1e-15, "2^{k}");
            assert_eq!(inverse(&Matrix::<2>::from_element(unit)), None);
        }
        assert_eq!(largest_eigenvalue(&Matrix::<3>::zeros()), 0.0);
        assert!(largest_eigenvalue(&Matrix::<3>::from_element(f64::NAN)).is_nan());
    }
}
