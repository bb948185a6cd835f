use carom_mesh::{Matrix, Vector};

/// The contact frame with rows n, t₁ (, t₂): right-handed, orthonormal.
///
/// In 2D t₁ is n turned by +90°; in 3D t₁ lies in the plane of n and the axis that n is least aligned with.
#[must_use]
pub fn frame<const D: usize>(normal: &Vector<D>) -> Matrix<D> {
    let mut rows = Matrix::<D>::zeros();
    rows.set_row(0, &normal.transpose());
    match D {
        2 => {
            rows[(1, 0)] = -normal[1];
            rows[(1, 1)] = normal[0];
        }
        3 => {
            let mut axis = Vector::zeros();
            axis[normal.iamin()] = 1.0;
            let t = (axis - normal * normal.dot(&axis)).normalize();
            rows.set_row(1, &t.transpose());
            for i in 0..3 {
                let (j, k) = ((i + 1) % 3, (i + 2) % 3);
                rows[(2, i)] = normal[j] * t[k] - normal[k] * t[j];
            }
        }
        _ => {}
    }
    rows
}

#[cfg(test)]
mod tests {
    use super::*;
    use carom_mesh::tensor::determinant;

    #[test]
    fn frames_are_rotations() {
        let n = Vector::<3>::new(0.3, -0.5, 0.8).normalize();
        let f = frame(&n);
        assert!((f * f.transpose() - Matrix::identity()).norm() < 1e-15);
        assert!((determinant(&f) - 1.0).abs() < 1e-15);
        let f = frame(&Vector::<2>::new(0.6, 0.8));
        assert!((f * f.transpose() - Matrix::identity()).norm() < 1e-15);
        assert!((determinant(&f) - 1.0).abs() < 1e-15);
    }
}
