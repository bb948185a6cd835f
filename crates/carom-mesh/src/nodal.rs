//! What is done with vectors of all nodes: changes node by node, and sums over the nodes.
//!
//! Threads share vectors of many nodes. A thread takes each of its sums in four parts, so that an addition need not wait for the one
//! before. A sum in one part takes three times as long as it takes to read the vectors.

use std::ops::Add;

use crate::parallel::{each_chunk, each_chunk_of_two, reduce};
use crate::{Matrix, Vector};

const PARTS: usize = 4;

/// So many zeros. What nobody writes to takes no memory where the system gives it by the page: copies of them do.
#[must_use]
pub fn zeros<const D: usize>(count: usize) -> Vec<Vector<D>> {
    bytemuck::zeroed_vec(count)
}

/// Calls `f` with every vector of `a`, and those of the `others` at the same node.
#[inline]
pub fn each<const D: usize, const K: usize>(
    a: &mut [Vector<D>],
    others: [&[Vector<D>]; K],
    f: impl Fn(&mut Vector<D>, [&Vector<D>; K]) + Sync,
) {
    each_chunk(a, |first, a| {
        let others = others.map(|other| &other[first..first + a.len()]);
        for (node, a) in a.iter_mut().enumerate() {
            f(a, others.map(|other| &other[node]));
        }
    });
}

/// Calls `f` with every vector of `a` and `b`, and those of the `others` at the same node.
#[inline]
pub fn each_of_two<const D: usize, const K: usize>(
    a: &mut [Vector<D>],
    b: &mut [Vector<D>],
    others: [&[Vector<D>]; K],
    f: impl Fn(&mut Vector<D>, &mut Vector<D>, [&Vector<D>; K]) + Sync,
) {
    each_chunk_of_two(a, b, |first, a, b| {
        let others = others.map(|other| &other[first..first + a.len()]);
        for (node, (a, b)) in a.iter_mut().zip(b).enumerate() {
            f(a, b, others.map(|other| &other[node]));
        }
    });
}

/// Σ a.
#[must_use]
pub fn total<const D: usize>(a: &[Vector<D>]) -> Vector<D> {
    let part = |a: &[Vector<D>]| {
        let mut parts = [Vector::zeros(); PARTS];
        let chunks = a.chunks_exact(PARTS);
        chunks.remainder().iter().for_each(|a| parts[0] += a);
        for chunk in chunks {
            parts.iter_mut().zip(chunk).for_each(|(part, a)| *part += a);
        }
        gathered(parts)
    };
    reduce(0..a.len(), &|nodes| part(&a[nodes]), &Add::add)
}

/// Whether every number is finite: a sum sees all that is not.
#[must_use]
pub fn is_finite<const D: usize>(a: &[Vector<D>]) -> bool {
    total(a).sum().is_finite()
}

/// Σ w a, over as many nodes as there are weights.
#[must_use]
pub fn weighted_total<const D: usize>(weights: &[f64], a: &[Vector<D>]) -> Vector<D> {
    let part = |weights: &[f64], a: &[Vector<D>]| {
        let mut parts = [Vector::zeros(); PARTS];
        let (weights, a) = (weights.chunks_exact(PARTS), a.chunks_exact(PARTS));
        weights.remainder().iter().zip(a.remainder()).for_each(|(w, a)| parts[0] += a * *w);
        for (weights, a) in weights.zip(a) {
            parts.iter_mut().zip(weights.iter().zip(a)).for_each(|(part, (w, a))| *part += a * *w);
        }
        gathered(parts)
    };
    reduce(0..weights.len(), &|nodes| part(&weights[nodes.clone()], &a[nodes]), &Add::add)
}

/// Σ a·b, for as many b.
#[must_use]
pub fn dot<const D: usize>(a: &[Vector<D>], b: &[Vector<D>]) -> f64 {
    let part = |a: &[Vector<D>], b: &[Vector<D>]| {
        let mut parts = [Vector::<D>::zeros(); PARTS];
        let (a, b) = (a.chunks_exact(PARTS), b.chunks_exact(PARTS));
        let rest = a.remainder().iter().zip(b.remainder());
        rest.for_each(|(a, b)| parts[0] += a.component_mul(b));
        for (a, b) in a.zip(b) {
            parts.iter_mut().zip(a.iter().zip(b)).for_each(|(part, (a, b))| *part += a.component_mul(b));
        }
        gathered(parts)
    };
    reduce(0..a.len(), &|nodes| part(&a[nodes.clone()], &b[nodes]), &Add::add).sum()
}

/// Σ a bᵀ, for as many b.
#[must_use]
pub fn moments<const D: usize>(a: &[Vector<D>], b: &[Vector<D>]) -> Matrix<D> {
    let part = |a: &[Vector<D>], b: &[Vector<D>]| {
        a.iter().zip(b).fold(Matrix::zeros(), |sum: Matrix<D>, (a, b)| sum + a * b.transpose())
    };
    reduce(0..a.len(), &|nodes| part(&a[nodes.clone()], &b[nodes]), &Add::add)
}

/// The largest size of a component; what is not a number does not count.
#[must_use]
pub fn largest<const D: usize>(a: &[Vector<D>]) -> f64 {
    let part = |a: &[Vector<D>]| {
        let mut parts = [Vector::<D>::zeros(); PARTS];
        let chunks = a.chunks_exact(PARTS);
        chunks.remainder().iter().for_each(|a| enlarge(&mut parts[0], a));
        for chunk in chunks {
            parts.iter_mut().zip(chunk).for_each(|(part, a)| enlarge(part, a));
        }
        parts.iter().map(Vector::max).fold(0.0, f64::max)
    };
    reduce(0..a.len(), &|nodes| part(&a[nodes]), &f64::max)
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
            assert_eq!(moments(&a, &b), a.iter().zip(&b).map(|(a, b)| a * b.transpose()).sum());
            assert_eq!(largest(&a), if n == 0 { 0.0 } else { (n + 7) as f64 });
        }
    }

    #[test]
    fn vectors_of_many_nodes_are_the_same_for_any_number_of_threads() {
        let n = 100_003;
        let a: Vec<Vector<3>> =
            (0..n).map(|k| Vector::from_fn(|i, _| (k as f64 * 1.7 + i as f64).sin())).collect();
        let b: Vec<Vector<3>> = a.iter().rev().copied().collect();
        let weights: Vec<f64> = a.iter().map(|a| a[1]).collect();
        let results = |threads| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
            pool.install(|| {
                let (mut c, mut d) = (a.clone(), b.clone());
                each(&mut c, [&a, &b], |c, [a, b]| *c += a * b[0]);
                each_of_two(&mut c, &mut d, [&a], |c, d, [a]| (*c, *d) = (*d - a, *c));
                (c, d, total(&a), weighted_total(&weights, &a), dot(&a, &b), moments(&a, &b), largest(&a))
            })
        };
        let one = results(1);
        assert_eq!(results(2), one);
        assert_eq!(results(3), one);
        let (c, d, sum, ..) = one;
        for k in [0, 1023, 1024, n - 1] {
            assert_eq!((c[k], d[k]), (b[k] - a[k], a[k] + a[k] * b[k][0]));
        }
        assert!((sum - a.iter().sum::<Vector<3>>()).norm() < 1e-9);
    }

    #[test]
    fn what_is_not_a_number_spoils_a_total_and_is_no_size() {
        let mut a = vec![Vector::<2>::new(1.0, -3.0); 9];
        for k in [0, 5, 8] {
            a[k][1] = f64::NAN;
            assert!(!total(&a).sum().is_finite());
            assert!(!is_finite(&a));
            assert_eq!(largest(&a), 3.0);
        }
    }
}
