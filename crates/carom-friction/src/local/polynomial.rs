//! Real roots of polynomials of degree 4 and less.

/// Calls `visit` with every root in [−1, 1] of c₀ + c₁ t + … + c₄ t⁴ that is a change of sign. It is also called with the minima
/// of the absolute value in between, where a double root hides from round-off.
///
/// The roots of a derivative separate those of the polynomial, so that each is alone in a bracket, where Newton's method
/// with bisection as a safeguard cannot miss it.
pub(super) fn visit_roots(c: [f64; 5], mut visit: impl FnMut(f64)) {
    // Derivatives: row k has degree k + 1 after 3 − k differentiations.
    let cubic = [c[1], 2.0 * c[2], 3.0 * c[3], 4.0 * c[4]];
    let quadratic = [cubic[1], 2.0 * cubic[2], 3.0 * cubic[3]];
    let linear = [quadratic[1], 2.0 * quadratic[2]];
    let mut turning = Roots::default();
    for coefficients in [&linear[..], &quadratic[..], &cubic[..]] {
        turning = roots_between(coefficients, &turning);
    }
    let roots = roots_between(&c, &turning);
    roots.as_slice().iter().chain(turning.as_slice()).for_each(|&t| visit(t));
}

#[derive(Debug, Clone, Copy, Default)]
struct Roots {
    count: usize,
    values: [f64; 4],
}

impl Roots {
    fn push(&mut self, t: f64) {
        self.values[self.count] = t;
        self.count += 1;
    }

    fn as_slice(&self) -> &[f64] {
        &self.values[..self.count]
    }
}

/// The roots in [−1, 1] of a polynomial with the turning points `turning`, ascending.
fn roots_between(c: &[f64], turning: &Roots) -> Roots {
    let mut roots = Roots::default();
    let (mut left, mut value) = (-1.0, evaluate(c, -1.0).0);
    for &right in turning.as_slice().iter().chain([&1.0]) {
        let value_right = evaluate(c, right).0;
        if (value < 0.0) != (value_right < 0.0) {
            roots.push(bracketed_newton(c, left, right, value < 0.0));
        }
        (left, value) = (right, value_right);
    }
    roots
}

/// The root between `left` and `right`, where a polynomial changes its sign.
fn bracketed_newton(c: &[f64], mut left: f64, mut right: f64, rises: bool) -> f64 {
    let mut t = 0.5 * (left + right);
    // Bisection alone reaches the last bit of a number of order 1 in 53 steps and of a smaller one later, to no avail.
    for _ in 0..60 {
        let (value, slope) = evaluate(c, t);
        if (value < 0.0) == rises {
            left = t;
        } else {
            right = t;
        }
        let newton = t - value / slope;
        let next = if newton > left && newton < right { newton } else { 0.5 * (left + right) };
        if (next - t).abs() <= 2.0 * f64::EPSILON {
            return next;
        }
        t = next;
    }
    t
}

/// Value and derivative by Horner's scheme.
#[inline]
fn evaluate(c: &[f64], t: f64) -> (f64, f64) {
    let (mut value, mut slope) = (0.0, 0.0);
    for &c in c.iter().rev() {
        slope = slope * t + value;
        value = value * t + c;
    }
    (value, slope)
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    proptest! {
        #[test]
        fn every_root_that_a_product_of_factors_shows_is_found(
            roots in proptest::array::uniform4(-1.5..1.5),
            scale in prop_oneof![0.1..10.0, -10.0..-0.1],
        ) {
            let mut c: [f64; 5] = [scale, 0.0, 0.0, 0.0, 0.0];
            let roots: [f64; 4] = roots;
            for root in roots {
                for k in (0..5).rev() {
                    c[k] = -root * c[k] + if k > 0 { c[k - 1] } else { 0.0 };
                }
            }
            let mut found = Vec::new();
            visit_roots(c, |t| found.push(t));
            for root in roots.into_iter().filter(|r| r.abs() < 1.0) {
                let nearest = found.iter().map(|t| (t - root).abs()).fold(f64::INFINITY, f64::min);
                // Roots of multiplicity m are known to ε^(1/m) only.
                prop_assert!(nearest < 1e-3, "{root} not in {found:?}");
            }
        }
    }

    #[test]
    fn lower_degrees_and_zero_are_polynomials_too() {
        let roots = |c| {
            let mut found = Vec::new();
            visit_roots(c, |t| found.push(t));
            found
        };
        assert!(roots([-0.5, 1.0, 0.0, 0.0, 0.0]).iter().any(|t| (t - 0.5).abs() < 1e-15));
        assert!(roots([-0.25, 0.0, 1.0, 0.0, 0.0]).iter().any(|t| (t + 0.5).abs() < 1e-15));
        assert!(roots([0.0; 5]).iter().all(|t| t.is_finite()));
        assert!(roots([1.0, 0.0, 0.0, 0.0, 0.0]).is_empty());
    }
}
