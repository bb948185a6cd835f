//! What two convex polygons in a plane, or two segments of a line, have in common.

use smallvec::SmallVec;

/// Coordinates in a plane; on a line the second is 0.
pub(super) type Point = [f64; 2];

/// The corners of a convex polygon, counter-clockwise, or the ends of a segment. Two quadrilaterals have eight corners in common
/// at most.
pub(super) type Polygon = SmallVec<[Point; 8]>;

/// The corners of a simplex; of a segment the third is not used.
pub(super) type Simplex = [Point; 3];

/// Turns corners that are given clockwise, or ends in falling order.
pub(super) fn orient(dimension: usize, corners: &mut Polygon) {
    let turned = match dimension {
        1 => corners[1][0] < corners[0][0],
        _ => simplices(dimension, corners).map(|s| size(dimension, &s)).sum::<f64>() < 0.0,
    };
    if turned {
        corners.reverse();
    }
}

/// The common part; without corners if there is none.
///
/// In a plane by Sutherland and Hodgman (Comm. ACM 17, 1974): `subject` is cut along every side of `window`.
pub(super) fn intersection(dimension: usize, subject: &Polygon, window: &Polygon) -> Polygon {
    if dimension == 1 {
        let (low, high) = (subject[0][0].max(window[0][0]), subject[1][0].min(window[1][0]));
        return if low < high { Polygon::from_slice(&[[low, 0.0], [high, 0.0]]) } else { Polygon::new() };
    }
    let mut part = subject.clone();
    let mut rest = Polygon::new();
    for (k, a) in window.iter().enumerate() {
        let b = &window[(k + 1) % window.len()];
        let inside = |p: &Point| cross(a, b, p);
        std::mem::swap(&mut part, &mut rest);
        part.clear();
        for (m, p) in rest.iter().enumerate() {
            let q = &rest[(m + 1) % rest.len()];
            let (from, to) = (inside(p), inside(q));
            if from >= 0.0 {
                part.push(*p);
            }
            if (from > 0.0 && to < 0.0) || (from < 0.0 && to > 0.0) {
                let s = from / (from - to);
                part.push([p[0] + s * (q[0] - p[0]), p[1] + s * (q[1] - p[1])]);
            }
        }
    }
    part
}

/// The simplices that make up a polygon or a segment.
pub(super) fn simplices(dimension: usize, polygon: &Polygon) -> impl Iterator<Item = Simplex> {
    let count = polygon.len().saturating_sub(dimension);
    (0..count).map(move |k| {
        if dimension == 1 {
            [polygon[0], polygon[1], polygon[1]]
        } else {
            [polygon[0], polygon[k + 1], polygon[k + 2]]
        }
    })
}

/// The simplices over which a polygon or a segment is integrated. One with more than three corners is cut from its centre: what a rule makes
/// of functions beyond its degree is then the same whichever corner comes first, and small edges that round-off adds change it by as little.
pub(super) fn cut(dimension: usize, polygon: &Polygon) -> SmallVec<[Simplex; 8]> {
    let fan = simplices(dimension, polygon);
    if polygon.len() <= dimension + 1 {
        return fan.collect();
    }
    // Of slivers the sign may be round-off: without it the centre is inside.
    let (mut whole, mut moment) = (0.0, [0.0; 2]);
    for simplex in fan {
        let share = size(dimension, &simplex).abs();
        whole += share;
        (0..2).for_each(|i| moment[i] += share * simplex.iter().map(|x| x[i]).sum::<f64>() / 3.0);
    }
    if whole == 0.0 {
        return SmallVec::new();
    }
    let centre = moment.map(|m| m / whole);
    let next = polygon.iter().cycle().skip(1);
    polygon.iter().zip(next).map(|(a, b)| [centre, *a, *b]).collect()
}

/// Length of a segment or area of a triangle; negative if it is turned.
pub(super) fn size(dimension: usize, [a, b, c]: &Simplex) -> f64 {
    if dimension == 1 { b[0] - a[0] } else { 0.5 * cross(a, b, c) }
}

/// Twice the area of the triangle a, b, c.
fn cross(a: &Point, b: &Point, c: &Point) -> f64 {
    (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
}

#[cfg(test)]
mod tests {
    use super::*;

    fn area(dimension: usize, polygon: &Polygon) -> f64 {
        simplices(dimension, polygon).map(|s| size(dimension, &s)).sum()
    }

    fn square(x: f64, y: f64, side: f64) -> Polygon {
        Polygon::from_slice(&[[x, y], [x + side, y], [x + side, y + side], [x, y + side]])
    }

    #[test]
    fn common_part_of_squares_that_overlap_touch_hold_and_miss_one_another() {
        let whole = square(0.0, 0.0, 2.0);
        for (other, expected) in [
            (square(1.0, 1.0, 2.0), 1.0),
            (square(0.5, 0.5, 1.0), 1.0),
            (square(-1.0, -1.0, 4.0), 4.0),
            (square(0.0, 0.0, 2.0), 4.0),
            (square(2.0, 0.0, 2.0), 0.0),
            (square(3.0, 3.0, 1.0), 0.0),
        ] {
            assert!((area(2, &intersection(2, &whole, &other)) - expected).abs() < 1e-15);
            assert!((area(2, &intersection(2, &other, &whole)) - expected).abs() < 1e-15);
        }
    }

    /// A square and the same turned by 45° have a regular octagon in common: 8(√2 − 1) for sides of 2.
    #[test]
    fn common_part_of_a_square_and_a_turned_one_is_an_octagon() {
        let r = 2.0_f64.sqrt();
        let mut turned = Polygon::from_slice(&[[0.0, r], [r, 0.0], [0.0, -r], [-r, 0.0]]);
        assert!(area(2, &turned) < 0.0);
        orient(2, &mut turned);
        let common = intersection(2, &square(-1.0, -1.0, 2.0), &turned);
        assert_eq!(common.len(), 8);
        assert!((area(2, &common) - 8.0 * (r - 1.0)).abs() < 1e-14);
    }

    /// What a rule of one point makes of a function that is beyond it, also where two corners are the same up to round-off.
    #[test]
    fn what_is_cut_is_the_same_from_whichever_corner_one_starts() {
        let mut corners = vec![[0.0, 0.0], [2.0, 0.3], [2.0, 0.3 + 1e-15], [1.7, 1.5], [0.2, 1.1]];
        let integral = |corners: &[Point]| {
            let at_middle = |s: &Simplex| (s.iter().map(|x| x[0] - 2.0 * x[1]).sum::<f64>() / 3.0).exp();
            let pieces = cut(2, &Polygon::from_slice(corners));
            pieces.iter().map(|s| size(2, s) * at_middle(s)).sum::<f64>()
        };
        let without = integral(&[corners[0], corners[1], corners[3], corners[4]]);
        for _ in 0..corners.len() {
            corners.rotate_left(1);
            assert!((integral(&corners) / without - 1.0).abs() < 1e-14);
        }
    }

    #[test]
    fn common_part_of_segments() {
        let mut segment = Polygon::from_slice(&[[3.0, 0.0], [1.0, 0.0]]);
        orient(1, &mut segment);
        for (ends, expected) in
            [([0.0, 2.0], 1.0), ([1.5, 2.0], 0.5), ([0.0, 4.0], 2.0), ([3.0, 4.0], 0.0), ([5.0, 6.0], 0.0)]
        {
            let other = Polygon::from_slice(&[[ends[0], 0.0], [ends[1], 0.0]]);
            assert!((area(1, &intersection(1, &segment, &other)) - expected).abs() < 1e-15);
        }
    }
}
