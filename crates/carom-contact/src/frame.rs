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
            return with_tangent(normal, &(axis - normal * normal.dot(&axis)).normalize());
        }
        _ => {}
    }
    rows
}

/// The frame in space with this normal and first tangent.
fn with_tangent<const D: usize>(normal: &Vector<D>, t: &Vector<D>) -> Matrix<D> {
    let mut rows = Matrix::<D>::zeros();
    rows.set_row(0, &normal.transpose());
    rows.set_row(1, &t.transpose());
    for i in 0..3 {
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        rows[(2, i)] = normal[j] * t[k] - normal[k] * t[j];
    }
    rows
}

/// The frame with the normal of `frame` whose tangents are those of `before` as nearly as they can be; `frame` itself where `before` has none, or
/// has turned over.
///
/// In space no choice of tangents is continuous for all normals, and components of a reaction only mean something in the frame that they are of.
/// Where a normal trembles by round-off about the vertical the tangents of [`frame`] turn by 90°.
#[must_use]
pub fn carried<const D: usize>(frame: &Matrix<D>, before: &Matrix<D>) -> Matrix<D> {
    if D < 3 {
        return *frame;
    }
    let normal: Vector<D> = frame.row(0).transpose();
    let tangent: Vector<D> = before.row(1).transpose();
    let tangent = tangent - normal * normal.dot(&tangent);
    let length = tangent.norm();
    if length < 0.5 { *frame } else { with_tangent(&normal, &(tangent / length)) }
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
        let g = carried(&frame(&Vector::<3>::new(0.2, -0.4, 0.9).normalize()), &f);
        assert!((g * g.transpose() - Matrix::identity()).norm() < 1e-15);
        assert!((determinant(&g) - 1.0).abs() < 1e-15);
        let f = frame(&Vector::<2>::new(0.6, 0.8));
        assert!((f * f.transpose() - Matrix::identity()).norm() < 1e-15);
        assert!((determinant(&f) - 1.0).abs() < 1e-15);
    }

    /// Symptom guarded against: a normal that trembled about the vertical turned the tangents by 90° from one iteration to the next.
    #[test]
    fn tangents_follow_a_normal_that_trembles() {
        for axis in 0..3 {
            let normal = |a: f64, b: f64| {
                let mut n = Vector::<3>::zeros();
                (n[axis], n[(axis + 1) % 3], n[(axis + 2) % 3]) = (-1.0, a, b);
                n.normalize()
            };
            let mut last = frame(&normal(1e-9, 2e-9));
            for (a, b) in [(2e-9, 1e-9), (-1e-9, 3e-9), (0.0, 0.0), (1e-3, -2e-3), (0.1, 0.2)] {
                let own = frame(&normal(a, b));
                let next = carried(&own, &last);
                assert_eq!(next.row(0), own.row(0));
                assert!((next - last).norm() < 4.0 * a.hypot(b) + 0.02, "{next} {last}");
                last = next;
            }
        }
        // Nothing to follow: no frame before, or one whose tangent is the normal now.
        let own = frame(&Vector::<3>::new(0.0, 0.6, 0.8));
        assert_eq!(carried(&own, &Matrix::zeros()), own);
        let across = frame(&Vector::<3>::new(1.0, 0.0, 0.0));
        let along: Vector<3> = across.row(1).transpose();
        assert_eq!(carried(&frame(&along), &across), frame(&along));
    }
}
