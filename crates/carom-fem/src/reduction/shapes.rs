//! The shapes in which a reduced body vibrates, node after node.

use carom_mesh::Vector;
use pulp::{Arch, Simd, WithSimd};

/// The displacements of every node for an amplitude of one of every vibration [1/√kg].
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Shapes<const D: usize> {
    count: usize,
    /// Of every node its displacements along one axis after the other, of one vibration after the other.
    values: Vec<f64>,
}

impl<const D: usize> Shapes<D> {
    /// Of so many vibrations and nodes, where `value` of a node, an axis and a vibration is its displacement.
    pub fn new(count: usize, nodes: usize, value: impl Fn(usize, usize, usize) -> f64) -> Self {
        let rows = (0..nodes).flat_map(|node| (0..D).map(move |i| (node, i)));
        let values = rows.flat_map(|(node, i)| (0..count).map(move |k| (node, i, k)));
        Self { count, values: values.map(|(node, i, k)| value(node, i, k)).collect() }
    }

    /// Those of a node, along every axis.
    #[inline]
    pub fn at(&self, node: usize) -> [&[f64]; D] {
        let own = &self.values[node * D * self.count..][..D * self.count];
        std::array::from_fn(|i| &own[i * self.count..][..self.count])
    }

    /// The displacements [m] of a node by as many sets of amplitudes [m √kg]; reading the shapes is what takes time.
    #[inline]
    pub fn displacements<const K: usize>(&self, node: usize, amplitudes: [&[f64]; K]) -> [Vector<D>; K] {
        Arch::new().dispatch(Products { shapes: self.at(node), amplitudes })
    }
}

/// The products of shapes along every axis with some amplitudes.
struct Products<'a, const D: usize, const K: usize> {
    shapes: [&'a [f64]; D],
    amplitudes: [&'a [f64]; K],
}

impl<const D: usize, const K: usize> WithSimd for Products<'_, D, K> {
    type Output = [Vector<D>; K];

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> [Vector<D>; K] {
        let shapes = self.shapes.map(S::as_simd_f64s);
        let amplitudes = self.amplitudes.map(S::as_simd_f64s);
        let mut sums = [[simd.splat_f64s(0.0); D]; K];
        for j in 0..shapes[0].0.len() {
            for (sums, (amplitudes, _)) in sums.iter_mut().zip(&amplitudes) {
                for (sum, (shape, _)) in sums.iter_mut().zip(&shapes) {
                    *sum = simd.mul_add_f64s(shape[j], amplitudes[j], *sum);
                }
            }
        }
        std::array::from_fn(|k| {
            Vector::from_fn(|i, _| {
                let rest: f64 = shapes[i].1.iter().zip(amplitudes[k].1).map(|(shape, a)| shape * a).sum();
                simd.reduce_sum_f64s(sums[k][i]) + rest
            })
        })
    }
}
