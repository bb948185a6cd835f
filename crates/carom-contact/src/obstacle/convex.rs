use carom_mesh::Vector;

use super::direction::along;
use crate::tolerances::SEARCH;

/// Signed distance and normal at `offset` [m] from the centre or the axis of a sphere or cylinder.
pub(super) fn round<const D: usize>(offset: &Vector<D>, radius: f64, cavity: bool) -> (f64, Vector<D>) {
    let distance = offset.norm();
    // At the very centre all directions are alike.
    let outward = if distance > 0.0 { offset / distance } else { along(0, 1.0) };
    if cavity { (radius - distance, -outward) } else { (distance - radius, outward) }
}

/// Signed distance and normal at `offset` [m] from the centre of a box with these half sides [m]. Inside, the nearest face decides;
/// outside, the nearest point, which may be on an edge or a corner.
pub(super) fn cuboid<const D: usize>(offset: &Vector<D>, half: &Vector<D>) -> (f64, Vector<D>) {
    let beyond = offset.abs() - half;
    let outside = beyond.sup(&Vector::zeros());
    let distance = outside.norm();
    let sign = |i: usize| 1.0_f64.copysign(offset[i]);
    // On an edge or corner the direction of the offset is round-off.
    if distance > SEARCH.touching * half.amax() {
        return (distance, Vector::from_fn(|i, _| sign(i) * outside[i] / distance));
    }
    let face = beyond.imax();
    (beyond[face], along(face, sign(face)))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The normal is the gradient of the distance, and a step of the distance against it ends on the surface.
    fn check<const D: usize>(gap: impl Fn(&Vector<D>) -> (f64, Vector<D>), x: Vector<D>) {
        let (distance, normal) = gap(&x);
        assert!((normal.norm() - 1.0).abs() < 1e-15);
        let h = 1e-6;
        for i in 0..D {
            let e = along(i, h);
            let slope = (gap(&(x + e)).0 - gap(&(x - e)).0) / (2.0 * h);
            assert!((slope - normal[i]).abs() < 1e-8, "{slope} {normal}");
        }
        assert!(gap(&(x - normal * distance)).0.abs() < 1e-15);
    }

    #[test]
    fn normals_are_the_gradients_of_the_distance() {
        let half = Vector::<3>::new(1.0, 0.5, 0.7);
        for x in [[1.5, 0.1, 0.2], [1.3, -0.9, 0.1], [-1.2, 0.8, -1.1], [0.9, 0.1, 0.3], [0.2, 0.3, -0.6]] {
            check(|x| cuboid(x, &half), Vector::from(x));
            for cavity in [false, true] {
                check(|x| round(x, 0.8, cavity), Vector::<3>::from(x));
                check(|x| round(x, 0.8, cavity), Vector::<2>::new(x[0], x[1]));
            }
        }
        check(|x| cuboid(x, &half.xy()), Vector::<2>::new(1.4, 0.9));
    }

    #[test]
    fn boxes_are_as_far_away_as_their_nearest_corner() {
        let half = Vector::<3>::repeat(1.0);
        assert!((cuboid(&Vector::<3>::repeat(2.0), &half).0 - 3.0_f64.sqrt()).abs() < 1e-15);
        assert!((cuboid(&Vector::<3>::new(0.0, 0.9, 0.0), &half).0 + 0.1).abs() < 1e-15);
        // Flush with a face up to round-off, at rest on the other: the face that it is farther in front of.
        let (gap, normal) = cuboid(&Vector::<3>::new(0.0, 1.0 + 1e-16, 1.0 + 3e-16), &half);
        assert!(gap < 1e-15 && normal == Vector::<3>::z());
    }

    #[test]
    fn the_centre_of_a_sphere_has_a_normal_too() {
        let (gap, normal) = round(&Vector::<3>::zeros(), 2.0, true);
        assert!(gap == 2.0 && normal.norm() == 1.0);
    }
}
