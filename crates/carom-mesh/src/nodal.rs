//! Sums over the nodes, of what there is one vector of per node.
//!
//! Each is taken in four parts, so that an addition need not wait for the one before: a sum in one part takes three times as long
//! as it takes to read the vectors.

use crate::Vector;

const PARTS: usize = 4;

/// Σ a.
#[must_use]
pub fn total<const D: usize>(a: &[Vector<D>]) -> Vector<D> {
    let mut parts = [Vector::zeros(); PARTS];
    let chunks = a.chunks_exact(PARTS);
    chunks.remainder().iter().for_each(|a| parts[0] += a);
    for chunk in chunks {
        parts.iter_mut().zip(chunk).for_each(|(part, a)| *part += a);
    }
    gathered(parts)
}

/// Σ w a, for as many weights.
#[must_use]
pub fn weighted_total<const D: usize>(weights: &[f64], a: &[Vector<D>]) -> Vector<D> {
    let mut parts = [Vector::zeros(); PARTS];
    let (weights, a) = (weights.chunks_exact(PARTS), a.chunks_exact(PARTS));
    weights.remainder().iter().zip(a.remainder()).for_each(|(w, a)| parts[0] += a * *w);
    for (weights, a) in weights.zip(a) {
        parts.iter_mut().zip(weights.iter().zip(a)).for_each(|(part, (w, a))| *part += a * *w);
    }
    gathered(parts)
}

/// Σ a·b, for as many b.
#[must_use]
pub fn dot<const D: usize>(a: &[Vector<D>], b: &[Vector<D>]) -> f64 {
    let mut parts = [Vector::<D>::zeros(); PARTS];
    let (a, b) = (a.chunks_exact(PARTS), b.chunks_exact(PARTS));
    let rest = a.remainder().iter().zip(b.remainder());
    rest.for_each(|(a, b)| parts[0] += a.component_mul(b));
    for (a, b) in a.zip(b) {
        parts.iter_mut().zip(a.iter().zip(b)).for_each(|(part, (a, b))| *part += a.component_mul(b));
    }
    gathered(parts).sum()
}

/// The largest size of a component; what is not a number does not count.
#[must_use]
pub fn largest<const D: usize>(a: &[Vector<D>]) -> f64 {
    let mut parts = [Vector::<D>::zeros(); PARTS];
    let chunks = a.chunks_exact(PARTS);
    chunks.remainder().iter().for_each(|a| enlarge(&mut parts[0], a));
    for chunk in chunks {
        parts.iter_mut().zip(chunk).for_each(|(part, a)| enlarge(part, a));
    }
    parts.iter().map(Vector::max).fold(0.0, f64::max)
}

#[inline(always)]
fn gathered<const D: usize>(parts: [Vector<D>; PARTS]) -> Vector<D> {
    parts[0] + parts[1] + (parts[2] + parts[3])
}

#[inline(always)]
fn enlarge<const D: usize>(largest: &mut Vector<D>, a: &Vector<D>) {
    for i in 0..D {
        let size = a[i].abs();
        largest[i] = if size > largest[i] { size } else { largest[i] };
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sums_are_those_of_one_node_after_the_other_for_any_number_of_nodes() {
        for n in 0..11 {
            let a: Vec<Vector<3>> = (0..n).map(|k| Vector::from_fn(|i, _| (k + 4 * i) as f64)).collect();
            let weights: Vec<f64> = (0..n).map(|k| (k * k) as f64).collect();
            assert_eq!(total(&a), a.iter().sum());
            assert_eq!(weighted_total(&weights, &a), a.iter().zip(&weights).map(|(a, w)| a * *w).sum());
            let b: Vec<Vector<3>> = a.iter().rev().copied().collect();
            assert_eq!(dot(&a, &b), a.iter().zip(&b).map(|(a, b)| a.dot(b)).sum());
            assert_eq!(largest(&a), if n == 0 { 0.0 } else { (n + 7) as f64 });
        }
    }

    #[test]
    fn what_is_not_a_number_spoils_a_total_and_is_no_size() {
        let mut a = vec![Vector::<2>::new(1.0, -3.0); 9];
        for k in [0, 5, 8] {
            a[k][1] = f64::NAN;
            assert!(!total(&a).sum().is_finite());
            assert_eq!(largest(&a), 3.0);
        }
    }
}
