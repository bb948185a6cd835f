//! The shape functions of Gregory patches on triangles and squares (Gregory 1974; Chiyokura & Kimura 1983; Longhi 1987).
//!
//! A patch has a cubic curve along each side, and across each side a slope that is cubic along it as well. A Bézier patch of third degree on a
//! square, or of fourth on a triangle, has one inner control point by each corner, which both sides there would place. Here it has two, one
//! for each side, and is a mean of both that is the first on the one side and the second on the other. So both sides have their slope.
//!
//! Control points are numbered as follows, with n corners: the corners; then for every side k from corner k to k + 1 the two between the ends of
//! its curve, at 1/3 and 2/3, and the two inner ones that are its own, in the same order.

use super::jet::Jet;
use crate::domain::Domain;

/// Control points of a patch, at most.
pub(super) const MAX_CONTROLS: usize = 20;

/// Control points of a patch over a domain.
pub(super) fn control_count(domain: Domain) -> usize {
    5 * domain.corners().len()
}

/// The first control point of a side between its ends.
pub(super) fn of_side(domain: Domain, side: usize) -> usize {
    domain.corners().len() + 4 * side
}

/// The shape functions at ξ. None is negative in the domain, and they sum to 1.
pub(super) fn shape(domain: Domain, xi: &[f64; 2]) -> [Jet; MAX_CONTROLS] {
    match domain {
        Domain::Triangle => on_triangle(xi),
        Domain::Square | Domain::Segment => on_square(xi),
    }
}

/// How far the inner control points of a side are from its curve: the slope across the side over this.
pub(super) fn degree_across(domain: Domain) -> f64 {
    if domain == Domain::Triangle { 4.0 } else { 3.0 }
}

fn on_triangle(xi: &[f64; 2]) -> [Jet; MAX_CONTROLS] {
    let b = [
        Jet::affine(1.0 - xi[0] - xi[1], [-1.0, -1.0]),
        Jet::affine(xi[0], [1.0, 0.0]),
        Jet::affine(xi[1], [0.0, 1.0]),
    ];
    let mut shape = [Jet::default(); MAX_CONTROLS];
    for k in 0..3 {
        let (s, t, o) = (b[k], b[(k + 1) % 3], b[(k + 2) % 3]);
        shape[k] = s * s * s;
        let st = s * t;
        let side = of_side(Domain::Triangle, k);
        // The cubic curve as one of fourth degree.
        let on_side = (st * (s + t)).times(3.0);
        shape[side] = on_side * s;
        shape[side + 1] = on_side * t;
        let inner = (st * o).times(12.0);
        shape[side + 2] = inner * s * t.share(o);
        shape[side + 3] = inner * t * s.share(o);
    }
    shape
}

fn on_square(xi: &[f64; 2]) -> [Jet; MAX_CONTROLS] {
    let one = Jet::constant(1.0);
    let [u, v] = [Jet::affine(0.5 * (1.0 + xi[0]), [0.5, 0.0]), Jet::affine(0.5 * (1.0 + xi[1]), [0.0, 0.5])];
    let (u1, v1) = (one - u, one - v);
    let bernstein =
        |s: Jet, s1: Jet| [s1 * s1 * s1, (s * s1 * s1).times(3.0), (s * s * s1).times(3.0), s * s * s];
    let (bu, bv) = (bernstein(u, u1), bernstein(v, v1));
    // Along and across each side: coordinates, and the functions of the four control points along it, of the two next to it across.
    let back = |b: [Jet; 4]| [b[3], b[2], b[1], b[0]];
    let sides = [
        (u, u1, v, bu, bv),
        (v, v1, u1, bv, back(bu)),
        (u1, u, v1, back(bu), back(bv)),
        (v1, v, u, back(bv), bu),
    ];
    let mut shape = [Jet::default(); MAX_CONTROLS];
    for (k, (s, s1, t, along, across)) in sides.into_iter().enumerate() {
        shape[k] = along[0] * across[0];
        let side = of_side(Domain::Square, k);
        shape[side] = along[1] * across[0];
        shape[side + 1] = along[2] * across[0];
        shape[side + 2] = along[1] * across[1] * s.share(t);
        shape[side + 3] = along[2] * across[1] * s1.share(t);
    }
    shape
}

#[cfg(test)]
mod tests {
    use super::*;

    fn points(domain: Domain) -> impl Iterator<Item = [f64; 2]> {
        (0..7).flat_map(|i| (0..7).map(move |j| [f64::from(i) / 6.0, f64::from(j) / 6.0])).map(
            move |[a, b]| {
                if domain == Domain::Triangle { [a, b * (1.0 - a)] } else { [2.0 * a - 1.0, 2.0 * b - 1.0] }
            },
        )
    }

    #[test]
    fn shape_functions_sum_to_one_and_are_not_negative() {
        for domain in [Domain::Triangle, Domain::Square] {
            for xi in points(domain) {
                let shape = shape(domain, &xi);
                let sum = shape.iter().fold(Jet::default(), |sum, &b| sum + b);
                assert!((sum.value - 1.0).abs() < 1e-15, "{domain:?} {xi:?}: {sum:?}");
                assert!(
                    sum.slope.iter().chain(&sum.bend).all(|d| d.abs() < 1e-13),
                    "{domain:?} {xi:?}: {sum:?}"
                );
                assert!(shape.iter().all(|b| b.value >= -1e-17));
                assert!(shape[control_count(domain)..].iter().all(|b| b.value == 0.0));
            }
        }
    }

    #[test]
    fn derivatives_are_those_of_differences() {
        let h = 1e-5;
        for domain in [Domain::Triangle, Domain::Square] {
            for xi in [[0.2, 0.3], [0.05, 0.01], [0.6, 0.3]] {
                let at = |a: f64, b: f64| shape(domain, &[xi[0] + a, xi[1] + b]);
                let (middle, right, left, up, down) =
                    (at(0.0, 0.0), at(h, 0.0), at(-h, 0.0), at(0.0, h), at(0.0, -h));
                for k in 0..control_count(domain) {
                    let by = |plus: f64, minus: f64| (plus - minus) / (2.0 * h);
                    let expected = [
                        by(right[k].value, left[k].value),
                        by(up[k].value, down[k].value),
                        by(right[k].slope[0], left[k].slope[0]),
                        by(up[k].slope[0], down[k].slope[0]),
                        by(up[k].slope[1], down[k].slope[1]),
                    ];
                    let [a, b] = middle[k].slope;
                    let [c, d, e] = middle[k].bend;
                    for (exact, expected) in [a, b, c, d, e].into_iter().zip(expected) {
                        assert!((exact - expected).abs() < 1e-4, "{domain:?} {k}: {exact} for {expected}");
                    }
                }
            }
        }
    }
}
