//! Integration over the simplices that facets are cut into.

/// A point in barycentric coordinates and its share of the whole.
pub(super) type Point = ([f64; 3], f64);

/// Gauss's rule of 3 points on a segment, exact to degree 5.
const SEGMENT: [Point; 3] = [
    ([0.887_298_334_620_741_7, 0.112_701_665_379_258_31, 0.0], 5.0 / 18.0),
    ([0.5, 0.5, 0.0], 4.0 / 9.0),
    ([0.112_701_665_379_258_31, 0.887_298_334_620_741_7, 0.0], 5.0 / 18.0),
];

/// Two equal barycentric coordinates `a` and what remains of 1.
const fn median(a: f64, weight: f64) -> [Point; 3] {
    let b = 1.0 - 2.0 * a;
    [([b, a, a], weight), ([a, b, a], weight), ([a, a, b], weight)]
}

const M4: [[Point; 3]; 2] = [
    median(0.445_948_490_915_964_9, 0.223_381_589_678_011_47),
    median(0.091_576_213_509_770_74, 0.109_951_743_655_321_87),
];

/// Dunavant's rule of 6 points on a triangle, exact to degree 4 (Int. J. Numer. Methods Eng. 21, 1985).
const TRIANGLE: [Point; 6] = [M4[0][0], M4[0][1], M4[0][2], M4[1][0], M4[1][1], M4[1][2]];

const M6: [[Point; 3]; 2] = [
    median(0.249_286_745_170_910_42, 0.116_786_275_726_379_37),
    median(0.063_089_014_491_502_23, 0.050_844_906_370_206_82),
];
const A: f64 = 0.053_145_049_844_816_95;
const B: f64 = 0.310_352_451_033_784_4;
const C: f64 = 1.0 - A - B;
const W: f64 = 0.082_851_075_618_373_57;

/// Dunavant's rule of 12 points on a triangle, exact to degree 6.
const TRIANGLE_OF_QUADRATIC: [Point; 12] = [
    M6[0][0],
    M6[0][1],
    M6[0][2],
    M6[1][0],
    M6[1][1],
    M6[1][2],
    ([A, B, C], W),
    ([B, C, A], W),
    ([C, A, B], W),
    ([A, C, B], W),
    ([C, B, A], W),
    ([B, A, C], W),
];

/// The rule for the product of a multiplier and a shape function on a simplex of this `dimension`.
pub(super) fn rule(dimension: usize, is_quadratic: bool) -> &'static [Point] {
    match (dimension, is_quadratic) {
        (1, _) => &SEGMENT,
        (_, false) => &TRIANGLE,
        (_, true) => &TRIANGLE_OF_QUADRATIC,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// ∫ λ₁^i λ₂^j over a simplex of dimension d and size 1 is d! i! j!/(d + i + j)!.
    #[test]
    fn rules_are_exact_to_their_degree() {
        let factorial = |n: i32| (1..=n).map(f64::from).product::<f64>();
        for (dimension, quadratic, degree) in [(1, false, 5), (1, true, 5), (2, false, 4), (2, true, 6)] {
            for i in 0..=degree {
                for j in 0..=degree - i {
                    let sum: f64 =
                        rule(dimension, quadratic).iter().map(|(l, w)| w * l[0].powi(i) * l[1].powi(j)).sum();
                    let d = dimension as i32;
                    let exact = factorial(d) * factorial(i) * factorial(j) / factorial(d + i + j);
                    assert!((sum - exact).abs() < 1e-15, "{dimension} {i} {j}: {sum} and not {exact}");
                }
            }
        }
    }
}
