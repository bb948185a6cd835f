//! The ends of the spectrum of a scaled matrix.

use nalgebra::DMatrix;

use super::control::CONTROL;
use super::scaled::{Columns, Scaled};

/// Estimates of the least and the largest eigenvalue, by Lanczos's iteration: the true ones are a little beyond. Not numbers if the matrix
/// has none.
///
/// It starts from a uniform motion, near the softest modes of a body, and a rough one, which reaches the stiffest.
pub(super) fn spectrum<const D: usize>(matrix: &Scaled<D>) -> [f64; 2] {
    let n = matrix.node_count();
    let steps = CONTROL.steps.min(matrix.graph().node_count() * D);
    let mut v: Vec<Columns<D, 1>> = (0..n).map(|node| start(matrix, node)).collect();
    let mut before = vec![[[0.0_f32; 1]; D]; n];
    let (mut diagonal, mut beside) = (Vec::new(), Vec::new());
    let mut norm = dot(matrix, &v, &v).sqrt();
    scale(&mut v, 1.0 / norm);
    for step in 0..steps {
        // before ← (A v − before·β), then without its part along v.
        let beta = beside.last().copied().unwrap_or(0.0) as f32;
        let products = matrix.times(&v);
        for (before, product) in before.iter_mut().zip(products) {
            for (before, product) in before.iter_mut().zip(product) {
                before[0] = product[0] - beta * before[0];
            }
        }
        let along = dot(matrix, &before, &v);
        diagonal.push(along);
        for (before, v) in before.iter_mut().zip(&v) {
            for (before, v) in before.iter_mut().zip(v) {
                before[0] -= along as f32 * v[0];
            }
        }
        norm = dot(matrix, &before, &before).sqrt();
        if !norm.is_finite() {
            return [f64::NAN; 2];
        }
        if norm < CONTROL.nothing * along.abs() || step + 1 == steps {
            break;
        }
        scale(&mut before, 1.0 / norm);
        std::mem::swap(&mut v, &mut before);
        beside.push(norm);
    }
    let tridiagonal = DMatrix::from_fn(diagonal.len(), diagonal.len(), |i, j| match i.abs_diff(j) {
        0 => diagonal[i],
        1 => beside[i.min(j)],
        _ => 0.0,
    });
    let eigenvalues = tridiagonal.symmetric_eigenvalues();
    [eigenvalues.min(), eigenvalues.max()]
}

/// The scaled uniform motion, and as much of one whose signs change in no order.
fn start<const D: usize>(matrix: &Scaled<D>, node: usize) -> Columns<D, 1> {
    let uniform = matrix.uniform(node);
    std::array::from_fn(|i| {
        let rough = if scrambled((matrix.node_at(node) * D + i) as u64) >> 63 == 0 { 1.0 } else { -1.0 };
        [uniform[i][0] * (1.0 + rough)]
    })
}

/// SplitMix64 (Steele, Lea & Flood 2014, *Fast splittable pseudorandom number generators*).
fn scrambled(n: u64) -> u64 {
    let mut x = (n + 1).wrapping_mul(0x9E37_79B9_7F4A_7C15);
    x = (x ^ (x >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    x = (x ^ (x >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
    x ^ (x >> 31)
}

fn dot<const D: usize>(matrix: &Scaled<D>, a: &[Columns<D, 1>], b: &[Columns<D, 1>]) -> f64 {
    let of = |(a, b): (&Columns<D, 1>, &Columns<D, 1>)| {
        a.iter().zip(b).map(|(a, b)| f64::from(a[0]) * f64::from(b[0])).sum::<f64>()
    };
    let each = a.iter().zip(b);
    let Some(rows) = matrix.rows() else { return each.map(of).sum() };
    let mut sum = [each.enumerate().map(|(place, pair)| rows.share(place) * of(pair)).sum()];
    rows.ranks().sum(&mut sum);
    sum[0]
}

fn scale<const D: usize>(v: &mut [Columns<D, 1>], by: f64) {
    v.iter_mut().flatten().for_each(|v| v[0] *= by as f32);
}
