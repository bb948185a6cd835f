//! The slope of a function at a point, from its values around it.

use carom_mesh::{Matrix, Vector};

/// Eigenvalues of the part that knows the second derivatives which are smaller than this fraction of its trace are of directions about which the points say
/// nothing. On a regular grid the smallest is an eighth of it.
const UNKNOWN: f64 = 0.01;

/// How the slope at a point follows from the rises of a function from there to others.
pub(super) struct Slope {
    /// Weights of the rises in both components.
    pub weights: Vec<[f64; 2]>,
    /// Whether the points know all second derivatives, so that a function of second degree has its exact slope.
    pub is_quadratic: bool,
}

impl Slope {
    /// The least-squares fit of a function of second degree through the point, with the `offsets` of others in the plane [m], weighted by their inverse
    /// distances. Second derivatives of which the points know nothing are zero: affine functions always have their exact slope.
    ///
    /// If the slope in the first direction `is_known`, rises are what is left without it, and its weights are zero. `None` if the points are on a line.
    pub fn fitted(offsets: &[[f64; 2]], is_known: bool) -> Option<Self> {
        let size = offsets.iter().map(|[p, q]| p.hypot(*q)).sum::<f64>() / offsets.len() as f64;
        let terms = |&[p, q]: &[f64; 2]| {
            let (p, q) = (p / size, q / size);
            let weight = 1.0 / (p * p + q * q);
            let first = Vector::<2>::new(if is_known { 0.0 } else { p }, q);
            (weight, first, Vector::<3>::new(0.5 * p * p, p * q, 0.5 * q * q))
        };
        let mut linear = Matrix::<2>::zeros();
        let mut bending = Matrix::<3>::zeros();
        // Products of both, one column for every second derivative.
        let mut mixed = [Vector::<2>::zeros(); 3];
        for offset in offsets {
            let (weight, first, second) = terms(offset);
            linear += first * first.transpose() * weight;
            bending += second * second.transpose() * weight;
            for (column, second) in mixed.iter_mut().zip(second.iter()) {
                *column += first * (weight * second);
            }
        }
        let scale = linear.trace();
        if is_known {
            linear[(0, 0)] = scale;
        }
        if linear.determinant() <= 1e-6 * scale * scale {
            return None;
        }
        let inverse = linear.try_inverse()?;
        let trace = bending.trace();
        for (i, a) in mixed.iter().enumerate() {
            for (j, b) in mixed.iter().enumerate() {
                bending[(i, j)] -= a.dot(&(inverse * b));
            }
        }
        let eigen = bending.symmetric_eigen();
        let known = |k: usize| eigen.eigenvalues[k] > UNKNOWN * trace;
        let weights = offsets.iter().map(|offset| {
            let (weight, first, second) = terms(offset);
            let rest = Vector::<3>::from_fn(|i, _| second[i] - mixed[i].dot(&(inverse * first)));
            let mut bend = Vector::<3>::zeros();
            for k in (0..3).filter(|&k| known(k)) {
                let direction: Vector<3> = eigen.eigenvectors.column(k).into_owned();
                bend += direction * (direction.dot(&rest) / eigen.eigenvalues[k]);
            }
            let less = mixed.iter().zip(bend.iter()).fold(first, |sum, (column, b)| sum - column * *b);
            let slope = inverse * less * (weight / size);
            [slope[0], slope[1]]
        });
        Some(Self { weights: weights.collect(), is_quadratic: (0..3).all(known) })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ring(count: usize, stretch: f64) -> Vec<[f64; 2]> {
        let angle = |k: usize| std::f64::consts::TAU * (k as f64 + 0.2 * (k as f64).sin()) / count as f64;
        (0..count).map(|k| [stretch * angle(k).cos(), angle(k).sin()]).collect()
    }

    #[test]
    fn functions_of_second_degree_have_their_exact_slope() {
        let f = |[p, q]: [f64; 2]| 0.3 * p - 1.2 * q + 0.7 * p * p - 0.4 * p * q + 0.2 * q * q;
        for count in [6, 8, 11] {
            let mut points = ring(count, 1.3);
            points.extend(ring(count, 0.6));
            let slope = Slope::fitted(&points, false).expect("around");
            assert!(slope.is_quadratic);
            let sum = points
                .iter()
                .zip(&slope.weights)
                .fold([0.0; 2], |s, (&x, w)| [s[0] + w[0] * f(x), s[1] + w[1] * f(x)]);
            assert!((sum[0] - 0.3).abs() < 1e-13 && (sum[1] + 1.2).abs() < 1e-13, "{sum:?}");
            let rest = points.iter().zip(&slope.weights).map(|(&x, _)| f(x) - 0.3 * x[0]);
            let known = Slope::fitted(&points, true).expect("around");
            let sum: f64 = rest.zip(&known.weights).map(|(rise, w)| rise * w[1]).sum();
            assert!((sum + 1.2).abs() < 1e-13 && known.weights.iter().all(|w| w[0] == 0.0));
        }
    }

    /// Three neighbours know no curvature; a strip knows none across it.
    #[test]
    fn few_points_know_planes() {
        let f = |[p, q]: [f64; 2]| 0.3 * p - 1.2 * q;
        let strip = vec![[-1.0, 0.0], [1.0, 0.0], [-1.0, 1.0], [0.0, 1.0], [1.0, 1.0]];
        for points in [ring(3, 1.0), ring(4, 2.0), strip] {
            let slope = Slope::fitted(&points, false).expect("around");
            assert!(!slope.is_quadratic);
            let sum = points
                .iter()
                .zip(&slope.weights)
                .fold([0.0; 2], |s, (&x, w)| [s[0] + w[0] * f(x), s[1] + w[1] * f(x)]);
            assert!((sum[0] - 0.3).abs() < 1e-14 && (sum[1] + 1.2).abs() < 1e-14, "{sum:?}");
        }
        assert!(Slope::fitted(&[[1.0, 0.0], [-2.0, 0.0]], false).is_none());
    }
}
