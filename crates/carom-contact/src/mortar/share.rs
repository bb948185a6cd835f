//! How much two planes of facets face one another: by degrees, so that what a multiplier sees never leaps while bodies move and turn.

use super::clip::{Polygon, intersection};
use super::plane::Plane;
use crate::tolerances::MORTAR;

/// What a part of the target in the plane `other` covers of the `outline` of one of the source in the plane `own`, where its own outline is the `window`, and
/// the share of that which counts; none if nothing does. `sizes` [m] are the diameters of both facets.
pub(super) fn common_part<const D: usize>(
    [own, other]: [&Plane<D>; 2],
    [outline, window]: [&Polygon; 2],
    sizes: [f64; 2],
) -> Option<(Polygon, f64)> {
    let by_angle = by_angle(own, other);
    if by_angle == 0.0 {
        return None;
    }
    let common = intersection(D - 1, outline, window);
    if common.is_empty() {
        return None;
    }
    let share = by_angle * by_distance([own, other], sizes, &common);
    (share > 0.0).then_some((common, share))
}

/// The share by the angle between two planes: 1 where they are opposite, 0 where they do not face one another.
fn by_angle<const D: usize>(own: &Plane<D>, other: &Plane<D>) -> f64 {
    rise(-own.normal().dot(&other.normal()), MORTAR.opposed)
}

/// The share by how far `other`, which is not at right angles, is before the plane `own` or behind it where both have the part `common`, which is
/// not empty. `sizes` [m] are the diameters of both facets.
fn by_distance<const D: usize>([own, other]: [&Plane<D>; 2], sizes: [f64; 2], common: &Polygon) -> f64 {
    let heights = common.iter().map(|point| own.height(other, point));
    let (low, high) = heights
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), height| (low.min(height), high.max(height)));
    let both = sizes[0] + sizes[1];
    let smaller = sizes[0].min(sizes[1]);
    let fall = |distance: f64, ends: [f64; 2], size: f64| 1.0 - rise(distance, ends.map(|end| end * size));
    fall(low, MORTAR.reach, both) * fall(-high, MORTAR.depth, smaller)
}

/// From 0 at the first of two ends to 1 at the second, with a slope of zero at both.
fn rise(x: f64, [from, to]: [f64; 2]) -> f64 {
    let t = ((x - from) / (to - from)).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

#[cfg(test)]
mod tests {
    use carom_mesh::Vector;

    use super::*;

    /// A segment of unit length whose middle is at this height over another that looks upwards, turned by this angle from facing it.
    fn turned(angle: f64, height: f64) -> Plane<2> {
        let (along, middle) =
            (Vector::<2>::new(angle.cos(), angle.sin()) * 0.5, Vector::<2>::new(0.0, height));
        Plane::through(&[middle - along, middle + along]).expect("a segment")
    }

    fn looking_up() -> Plane<2> {
        Plane::through(&[Vector::<2>::new(0.5, 0.0), Vector::<2>::new(-0.5, 0.0)]).expect("a segment")
    }

    #[test]
    fn facets_face_one_another_by_degrees_of_their_angle() {
        let at = |degrees: f64| by_angle(&looking_up(), &turned(degrees.to_radians(), 0.1));
        for degrees in [0.0, 30.0, -45.0] {
            assert!((at(degrees) - 1.0).abs() < 1e-14, "{degrees}");
        }
        assert_eq!([60.1, 90.0, 180.0].map(at), [0.0; 3]);
        let middle = at(0.5_f64.midpoint(0.5_f64.sqrt()).acos().to_degrees());
        assert!((middle - 0.5).abs() < 1e-14, "{middle}");
    }

    #[test]
    fn facets_face_one_another_by_degrees_of_their_distance() {
        let common = Polygon::from_slice(&[[-0.5, 0.0], [0.5, 0.0]]);
        let at = |height: f64| by_distance([&looking_up(), &turned(0.0, height)], [1.0, 1.0], &common);
        for (height, share) in
            [(-0.26, 0.0), (-0.1875, 0.5), (-0.12, 1.0), (0.0, 1.0), (0.49, 1.0), (0.75, 0.5), (1.01, 0.0)]
        {
            assert!((at(height) - share).abs() < 1e-14, "{height}: {}", at(height));
        }
    }

    /// Of an inclined facet the nearest point counts.
    #[test]
    fn a_facet_that_touches_with_one_end_faces_wholly() {
        let common = Polygon::from_slice(&[[-0.35, 0.0], [0.35, 0.0]]);
        let inclined = turned(std::f64::consts::FRAC_PI_4, 0.35);
        assert!((by_distance([&looking_up(), &inclined], [1.0, 1.0], &common) - 1.0).abs() < 1e-14);
    }
}
