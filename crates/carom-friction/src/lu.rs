//! LU factors of the contacts' matrices, by blocks or full.

use crate::block_lu::{BlockLu, NoBlockFactor, NoStructure};
use crate::clock::Clock;
use crate::dense_lu::DenseLu;
use crate::{BlockMatrix, Matrix, Vector};

/// A factor that Newton's method on contacts renews in every iteration.
#[derive(Debug)]
pub(crate) enum Lu<const D: usize> {
    Blocks(BlockLu<D>),
    Dense(DenseLu<D>),
}

/// Contacts from which a full factor pays, if at least one in so many blocks of its own would not be zero. Measured: at 100 contacts in
/// space it takes half of the time of blocks, at 289 a fifth.
const FULL: (usize, usize) = (60, 2);

/// Products of blocks, as sweeps make them, in the time of one of a full factor. Measured: 2.2 to 3.3 from 60 to 400 contacts in space.
const FASTER: usize = 3;

impl<const D: usize> Lu<D> {
    /// Finds the structure of factors of matrices with the pattern of `w`, of at most `max_blocks` blocks.
    pub fn new(w: &BlockMatrix<D>, max_blocks: usize, clock: Clock) -> Result<Self, NoStructure> {
        let blocks = BlockLu::new(w, max_blocks, clock)?;
        let n = w.row_count();
        let is_full = n >= FULL.0 && FULL.1 * blocks.block_count() >= n * n;
        Ok(if is_full { Self::Dense(DenseLu::new(n)) } else { Self::Blocks(blocks) })
    }

    /// What a factorisation costs, in products of blocks.
    pub fn products(&self) -> usize {
        match self {
            Self::Blocks(lu) => lu.products(),
            Self::Dense(lu) => lu.products() / FASTER,
        }
    }

    /// Factorises the matrix with the rows A_i (W + shift I)_i + B_i.
    pub fn factorize(
        &mut self,
        w: &BlockMatrix<D>,
        shift: f64,
        a: &[Matrix<D>],
        b: &[Matrix<D>],
        clock: Clock,
    ) -> Result<(), NoBlockFactor> {
        match self {
            Self::Blocks(lu) => lu.factorize(w, shift, a, b, clock),
            Self::Dense(lu) => lu.factorize(w, shift, a, b, clock),
        }
    }

    /// Overwrites the right-hand side `x` with the solution.
    pub fn solve(&mut self, x: &mut [Vector<D>]) {
        match self {
            Self::Blocks(lu) => lu.solve(x),
            Self::Dense(lu) => lu.solve(x),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Contacts that all feel one another, one of them open, one of them slipping: an unsymmetric matrix that takes row exchanges.
    #[test]
    fn full_factor_solves_what_the_one_of_blocks_solves() {
        let n = 64;
        let mut w = BlockMatrix::<3>::default();
        let noise =
            |i: usize, j: usize| Matrix::<3>::from_fn(|r, c| ((i * 7 + j * 3 + r * 5 + c * 11) as f64).sin());
        for i in 0..n {
            let block =
                |j: usize| noise(i, j) + if i == j { Matrix::identity() * 40.0 } else { Matrix::zeros() };
            w.push_row((0..n).map(|j| (j, block(j))));
        }
        let mut a: Vec<Matrix<3>> = (0..n).map(|i| Matrix::identity() + noise(i, 1) * 0.1).collect();
        let mut b = vec![Matrix::identity() * 0.2; n];
        (a[4], b[4]) = (Matrix::zeros(), Matrix::identity());
        let clock = Clock::new(None);
        let lu = Lu::new(&w, usize::MAX, clock).expect("few blocks");
        assert!(matches!(lu, Lu::Dense(_)));
        let blocks = BlockLu::new(&w, usize::MAX, clock).expect("few blocks");
        let right: Vec<Vector<3>> =
            (0..n).map(|i| Vector::from_fn(|k, _| ((i * 3 + k) as f64).cos())).collect();
        let solutions = [lu, Lu::Blocks(blocks)].map(|mut lu| {
            lu.factorize(&w, 0.5, &a, &b, clock).expect("strong diagonal");
            let mut x = right.clone();
            lu.solve(&mut x);
            x
        });
        for (x, y) in solutions[0].iter().zip(&solutions[1]) {
            assert!((x - y).norm() < 1e-13);
        }
    }

    #[test]
    fn full_factor_of_a_singular_matrix_says_so() {
        let n = 60;
        let mut w = BlockMatrix::<2>::default();
        (0..n).for_each(|_| w.push_row((0..n).map(|j| (j, Matrix::from_element(1.0)))));
        let clock = Clock::new(None);
        let mut lu = Lu::new(&w, usize::MAX, clock).expect("few blocks");
        let (a, b) = (vec![Matrix::identity(); n], vec![Matrix::zeros(); n]);
        assert_eq!(lu.factorize(&w, 0.0, &a, &b, clock), Err(NoBlockFactor::SmallPivot));
    }
}
