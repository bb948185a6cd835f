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
/// Where a normal trembles by round-off about the vertical the tangents of [`frame`] turn by 90°. Tangents that are [stretched](stretched) stay so.
#[must_use]
pub fn carried<const D: usize>(frame: &Matrix<D>, before: &Matrix<D>) -> Matrix<D> {
    if D < 3 {
        return *frame;
    }
    let normal: Vector<D> = frame.row(0).transpose();
    let lengths = lengths(before);
    let tangent: Vector<D> = before.row(1).transpose() / lengths[0];
    let tangent = tangent - normal * normal.dot(&tangent);
    let length = tangent.norm();
    // Where there is none before, its length is no number.
    if length >= 0.5 { stretch(with_tangent(&normal, &(tangent / length)), lengths) } else { *frame }
}

/// The frame with the normal of `frame` whose first tangent is as nearly along `direction` as it can be, with tangents of these `lengths`. None where
/// the direction stands on the surface.
///
/// In a frame whose tangents are shorter the elliptic cone of orthotropic friction is a circular one, and the work of reactions is what it is.
#[must_use]
pub fn stretched<const D: usize>(
    frame: &Matrix<D>,
    direction: &Vector<D>,
    lengths: [f64; 2],
) -> Option<Matrix<D>> {
    let normal: Vector<D> = frame.row(0).transpose();
    let tangent = direction - normal * normal.dot(direction);
    let length = tangent.norm();
    let lies = D == 3 && length > ALONG * direction.norm();
    lies.then(|| stretch(with_tangent(&normal, &(tangent / length)), lengths))
}

/// The sine of the angle with the normal below which no direction in the surface is meant.
const ALONG: f64 = 1e-6;

/// Lengths this near to one are one.
const ROUND_OFF: f64 = 1e-9;

/// The lengths of the tangents of a frame in space, exactly one where they are not stretched.
pub(crate) fn lengths<const D: usize>(frame: &Matrix<D>) -> [f64; 2] {
    [1, 2].map(|k| {
        let length = frame.row(k.min(D - 1)).norm();
        if (length - 1.0).abs() < ROUND_OFF { 1.0 } else { length }
    })
}

/// Makes the tangents of a frame in space as long as that.
fn stretch<const D: usize>(mut frame: Matrix<D>, lengths: [f64; 2]) -> Matrix<D> {
    for (k, length) in lengths.into_iter().enumerate() {
        frame.row_mut((k + 1).min(D - 1)).scale_mut(length);
    }
    frame
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

    #[test]
    fn tangents_that_are_stretched_stay_so_where_they_are_carried() {
        let own = frame(&Vector::<3>::new(0.0, 0.6, 0.8));
        let direction = Vector::<3>::new(0.5, -0.2, 0.7);
        let made = stretched(&own, &direction, [0.2, 1.0]).expect("it lies in the surface");
        assert_eq!(made.row(0), own.row(0));
        assert!((made.row(1).norm() - 0.2).abs() < 1e-15 && made.row(1).dot(&made.row(2)).abs() < 1e-15);
        assert!(made.row(1).transpose().dot(&direction) > 0.0);
        let carried_on = carried(&frame(&Vector::<3>::new(0.1, 0.6, 0.8).normalize()), &made);
        let [along, across] = lengths(&carried_on);
        assert!((along - 0.2).abs() < 1e-15 && across == 1.0);
        assert!(stretched(&own, &Vector::<3>::new(0.0, 1.2, 1.6), [0.2, 1.0]).is_none());
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
