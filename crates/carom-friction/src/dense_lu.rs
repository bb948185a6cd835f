//! LU factor of the full matrix of contacts that nearly all feel one another, as those of a body in statics do.

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::lu::partial_pivoting::{factor, solve};
use faer::perm::PermRef;
use faer::{Mat, MatMut, Par, Spec};

use crate::block_lu::NoBlockFactor;
use crate::clock::Clock;
use crate::{BlockMatrix, Matrix, Vector, speed};

/// LU factor with row exchanges of a full matrix of D × D blocks.
///
/// Where most of the factor would be full it is several times as fast as that of blocks, which takes them one by one.
pub(crate) struct DenseLu<const D: usize> {
    values: Mat<f64>,
    /// The row that stands k-th after the exchanges, and the inverse of that.
    rows: Vec<usize>,
    places: Vec<usize>,
    memory: MemBuffer,
    flat: Vec<f64>,
}

impl<const D: usize> std::fmt::Debug for DenseLu<D> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("DenseLu").field("rows", &self.rows.len()).finish_non_exhaustive()
    }
}

/// A pivot smaller than this share of the largest value of the matrix is too small to divide by.
const PIVOT: f64 = 1e-14;

impl<const D: usize> DenseLu<D> {
    /// Of matrices with so many rows of blocks.
    pub fn new(count: usize) -> Self {
        let n = count * D;
        let request = factor::lu_in_place_scratch::<usize, f64>(n, n, Par::Seq, Spec::default())
            .or(solve::solve_in_place_scratch::<usize, f64>(n, 1, Par::Seq));
        Self {
            values: Mat::zeros(n, n),
            rows: vec![0; n],
            places: vec![0; n],
            memory: MemBuffer::new(request),
            flat: vec![0.0; n],
        }
    }

    /// Products of blocks in a factorisation.
    pub fn products(&self) -> usize {
        (self.rows.len() / D).pow(3) / 3
    }

    /// Factorises the matrix with the rows A_i (W + shift I)_i + B_i, if there is time for it: once begun it cannot be cut short.
    pub fn factorize(
        &mut self,
        w: &BlockMatrix<D>,
        shift: f64,
        a: &[Matrix<D>],
        b: &[Matrix<D>],
        clock: Clock,
    ) -> Result<(), NoBlockFactor> {
        let time = (self.products() * D.pow(3)) as f64 / speed::multiplications_per_second();
        if clock.left().is_some_and(|left| left.as_secs_f64() < time) {
            return Err(NoBlockFactor::TimeIsUp);
        }
        let Self { values, rows, places, memory, .. } = self;
        values.as_mut().fill(0.0);
        for i in 0..w.row_count() {
            let mut put = |j: usize, block: &Matrix<D>| {
                for column in 0..D {
                    (0..D).for_each(|row| values[(i * D + row, j * D + column)] += block[(row, column)]);
                }
            };
            // The row of an open contact is that of B alone.
            if a[i] != Matrix::<D>::zeros() {
                w.row(i).for_each(|(j, block)| put(j, &(a[i] * block)));
            }
            put(i, &(a[i] * shift + b[i]));
        }
        let size = values.norm_max();
        let stack = MemStack::new(memory);
        factor::lu_in_place(values.as_mut(), rows, places, Par::Seq, stack, Spec::default());
        let is_small = |k: usize| values[(k, k)].abs() <= PIVOT * size || !values[(k, k)].is_finite();
        if (0..rows.len()).any(is_small) { Err(NoBlockFactor::SmallPivot) } else { Ok(()) }
    }

    /// Overwrites the right-hand side `x` with the solution.
    pub fn solve(&mut self, x: &mut [Vector<D>]) {
        let Self { values, rows, places, memory, flat } = self;
        flat.chunks_exact_mut(D).zip(&*x).for_each(|(flat, x)| flat.copy_from_slice(x.as_slice()));
        let (factors, n) = (values.as_ref(), rows.len());
        solve::solve_in_place(
            factors,
            factors,
            PermRef::new_checked(rows, places, n),
            MatMut::from_column_major_slice_mut(flat, n, 1),
            Par::Seq,
            MemStack::new(memory),
        );
        flat.chunks_exact(D).zip(x).for_each(|(flat, x)| x.copy_from_slice(flat));
    }
}
