//! Integration over the simplices that facets are cut into.

/// A point in barycentric coordinates and its share of the whole.
pub(super) type Point = ([f64; 3], f64);

/// The rule for the product of a multiplier and a shape function on a simplex of this `dimension`. On a segment it is that of Gauss,
/// exact to degree 5; on a triangle that of Dunavant, exact to degree 4 or 6 (Int. J. Numer. Methods Eng. 21, 1985).
pub(super) fn rule(dimension: usize, is_quadratic: bool) -> &'static [Point] {
    match (dimension, is_quadratic) {
        (1, _) => &[
            ([0.887_298_334_620_741_7, 0.112_701_665_379_258_31, 0.0], 5.0 / 18.0),
            ([0.5, 0.5, 0.0], 4.0 / 9.0),
            ([0.112_701_665_379_258_31, 0.887_298_334_620_741_7, 0.0], 5.0 / 18.0),
        ],
        (_, false) => const { &six_points() },
        (_, true) => const { &twelve_points() },
    }
}

const fn six_points() -> [Point; 6] {
    let [a, b, c] = median(0.445_948_490_915_964_9, 0.223_381_589_678_011_47);
    let [d, e, f] = median(0.091_576_213_509_770_74, 0.109_951_743_655_321_87);
    [a, b, c, d, e, f]
}

const fn twelve_points() -> [Point; 12] {
    let [a, b, c] = median(0.249_286_745_170_910_42, 0.116_786_275_726_379_37);
    let [d, e, f] = median(0.063_089_014_491_502_23, 0.050_844_906_370_206_82);
    let (x, y, weight) = (0.053_145_049_844_816_95, 0.310_352_451_033_784_4, 0.082_851_075_618_373_57);
    let z = 1.0 - x - y;
    let [g, h, i] = [([x, y, z], weight), ([y, z, x], weight), ([z, x, y], weight)];
    let [j, k, l] = [([x, z, y], weight), ([z, y, x], weight), ([y, x, z], weight)];
    [a, b, c, d, e, f, g, h, i, j, k, l]
}

/// The three points with two equal barycentric coordinates `a`.
const fn median(a: f64, weight: f64) -> [Point; 3] {
    let b = 1.0 - 2.0 * a;
    [([b, a, a], weight), ([a, b, a], weight), ([a, a, b], weight)]
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
