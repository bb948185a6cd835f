//! Small fixed-size vectors and matrices, with closed forms for D ≤ 3.

use nalgebra::{SMatrix, SVector};

/// A vector of space.
pub type Vector<const D: usize> = SVector<f64, D>;
/// A second-order tensor of space.
pub type Matrix<const D: usize> = SMatrix<f64, D, D>;

/// Matrix of cofactors, so that `m⁻¹ = cof(m)ᵀ / det(m)`.
///
/// # Panics
/// If `D` is not 1, 2 or 3.
#[must_use]
pub fn cofactor<const D: usize>(m: &Matrix<D>) -> Matrix<D> {
    match D {
        1 => Matrix::from_element(1.0),
        2 => {
            let mut c = Matrix::zeros();
            c[(0, 0)] = m[(1, 1)];
            c[(0, 1)] = -m[(1, 0)];
            c[(1, 0)] = -m[(0, 1)];
            c[(1, 1)] = m[(0, 0)];
            c
        }
        3 => Matrix::from_fn(|i, j| {
            let (a, b) = ((i + 1) % 3, (i + 2) % 3);
            let (c, d) = ((j + 1) % 3, (j + 2) % 3);
            m[(a, c)] * m[(b, d)] - m[(a, d)] * m[(b, c)]
        }),
        _ => unreachable!("space has one, two or three dimensions"),
    }
}

/// Determinant.
#[must_use]
pub fn determinant<const D: usize>(m: &Matrix<D>) -> f64 {
    first_row_expansion(m, &cofactor(m))
}

/// The determinant of m by its first row and its cofactors.
#[inline]
fn first_row_expansion<const D: usize>(m: &Matrix<D>, cofactors: &Matrix<D>) -> f64 {
    (0..D).map(|j| m[(0, j)] * cofactors[(0, j)]).sum()
}

/// Inverse and determinant. The inverse of a singular matrix has entries that are not finite.
#[must_use]
pub fn inverse<const D: usize>(m: &Matrix<D>) -> (Matrix<D>, f64) {
    let c = cofactor(m);
    let det = first_row_expansion(m, &c);
    (c.transpose() / det, det)
}

/// The rotation R of the polar decomposition m = R U.
///
/// In 2D in closed form, otherwise by Newton's iteration R ← ½(R + R⁻ᵀ) (Higham 1986), which converges quadratically for
/// any m with det m > 0. Returns `None` where there is no rotation to find (det m ≤ 0 or m not finite).
#[must_use]
pub fn closest_rotation<const D: usize>(m: &Matrix<D>) -> Option<Matrix<D>> {
    let det = determinant(m);
    if !(det.is_finite() && det > 0.0) {
        return None;
    }
    if D == 2 {
        let (c, s) = (m[(0, 0)] + m[(1, 1)], m[(1, 0)] - m[(0, 1)]);
        let norm = c.hypot(s);
        let mut r = Matrix::identity();
        r[(0, 0)] = c / norm;
        r[(1, 1)] = c / norm;
        r[(1, 0)] = s / norm;
        r[(0, 1)] = -s / norm;
        return Some(r);
    }
    let mut r = m / det.powf(1.0 / D as f64);
    for _ in 0..60 {
        let next = (r + cofactor(&r) / determinant(&r)) * 0.5;
        let change = (next - r).norm();
        r = next;
        if change <= 1e-15 {
            break;
        }
    }
    Some(r)
}

/// The moment a × b as (z) in 2D and (x, y, z) in 3D; unused components are zero.
#[must_use]
pub fn cross<const D: usize>(a: &Vector<D>, b: &Vector<D>) -> [f64; 3] {
    match D {
        2 => [0.0, 0.0, a[0] * b[1] - a[1] * b[0]],
        3 => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]],
        _ => [0.0; 3],
    }
}

/// The velocity ω × x of a rigid rotation with angular velocity ω = (ω_x, ω_y, ω_z) [rad/s].
#[must_use]
pub fn rotation_velocity<const D: usize>(omega: &[f64; 3], x: &Vector<D>) -> Vector<D> {
    let mut v = Vector::zeros();
    match D {
        2 => {
            v[0] = -omega[2] * x[1];
            v[1] = omega[2] * x[0];
        }
        3 => {
            v[0] = omega[1] * x[2] - omega[2] * x[1];
            v[1] = omega[2] * x[0] - omega[0] * x[2];
            v[2] = omega[0] * x[1] - omega[1] * x[0];
        }
        _ => {}
    }
    v
}

/// The rotation by the vector φ = (φ_x, φ_y, φ_z) [rad] (Rodrigues); in 2D by φ_z.
#[must_use]
pub fn rotation<const D: usize>(phi: &[f64; 3]) -> Matrix<D> {
    let angle = phi.iter().map(|x| x * x).sum::<f64>().sqrt();
    let mut spin = Matrix::<D>::zeros();
    for j in 0..D {
        let mut axis = Vector::zeros();
        axis[j] = 1.0;
        spin.set_column(j, &rotation_velocity(phi, &axis));
    }
    // sin φ/φ and (1 − cos φ)/φ², which tend to 1 and ½.
    let (s, c) = if angle > 1e-8 {
        (angle.sin() / angle, 0.5 * ((0.5 * angle).sin() / (0.5 * angle)).powi(2))
    } else {
        (1.0, 0.5)
    };
    Matrix::identity() + spin * s + spin * spin * c
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn inverse_times_matrix_is_identity() {
        let m = Matrix::<3>::new(2.0, 0.3, -0.1, 0.7, 1.5, 0.2, -0.4, 0.9, 3.0);
        let (inv, det) = inverse(&m);
        assert!((inv * m - Matrix::identity()).norm() < 1e-15);
        assert!((det - determinant(&m)).abs() < 1e-15);
        let m = Matrix::<2>::new(2.0, 0.3, -0.1, 0.7);
        assert!((inverse(&m).0 * m - Matrix::identity()).norm() < 1e-15);
    }

    #[test]
    fn polar_decomposition_recovers_the_rotation() {
        let (c, s) = (0.3_f64.cos(), 0.3_f64.sin());
        let r = Matrix::<3>::new(c, -s, 0.0, s, c, 0.0, 0.0, 0.0, 1.0)
            * Matrix::<3>::new(1.0, 0.0, 0.0, 0.0, s, -c, 0.0, c, s);
        let u = Matrix::<3>::new(1.4, 0.2, 0.1, 0.2, 0.8, -0.1, 0.1, -0.1, 1.1);
        assert!((closest_rotation(&(r * u)).expect("det > 0") - r).norm() < 1e-14);
        let r = Matrix::<2>::new(c, -s, s, c);
        let u = Matrix::<2>::new(1.4, 0.2, 0.2, 0.8);
        assert!((closest_rotation(&(r * u)).expect("det > 0") - r).norm() < 1e-15);
        assert!(closest_rotation(&Matrix::<2>::new(1.0, 0.0, 0.0, -1.0)).is_none());
    }

    #[test]
    fn rotation_by_a_vector_is_that_of_nalgebra() {
        for phi in [[0.0; 3], [1e-9, 0.0, 2e-9], [0.3, -0.8, 1.1]] {
            let reference = nalgebra::Rotation3::from_scaled_axis(nalgebra::Vector3::from(phi));
            assert!((rotation::<3>(&phi) - reference.matrix()).norm() < 1e-15);
        }
        let quarter = rotation::<2>(&[0.0, 0.0, std::f64::consts::FRAC_PI_2]);
        assert!((quarter * Vector::<2>::new(1.0, 0.0) - Vector::<2>::new(0.0, 1.0)).norm() < 1e-15);
    }
}
