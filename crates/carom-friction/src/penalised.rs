use faer::dyn_stack::MemBuffer;
use faer::sparse::SymbolicSparseColMat;

use crate::block_lu::{BlockLu, NoBlockFactor, NoStructure};
use crate::clock::Clock;
use crate::sparse_factor::{NoFactor, SparseFactor};
use crate::{BlockMatrix, Matrix, Vector};

/// Factor of W + diag(p_i I) with a penalty p_i [m/N] for every contact.
pub(crate) enum Penalised<'a, const D: usize> {
    /// Of small and of unsymmetric matrices.
    Blocks(Box<Blocks<'a, D>>),
    /// Of large symmetric ones.
    Supernodes(Box<Supernodes<D>>),
}

/// Blocks of a factor from which on supernodes pay: they renew that of 10⁴ contacts ten times as fast.
const MANY_BLOCKS: usize = 60_000;

impl<'a, const D: usize> Penalised<'a, D> {
    /// Finds the structure of the factors.
    pub fn new(w: &'a BlockMatrix<D>, clock: Clock) -> Result<Self, NoFactor> {
        let lu = match BlockLu::new(w, MANY_BLOCKS, clock) {
            Err(NoStructure::TooLarge) if w.is_symmetric() => {
                return Ok(Self::Supernodes(Box::new(Supernodes::new(w, clock)?)));
            }
            Err(NoStructure::TooLarge) => BlockLu::new(w, usize::MAX, clock),
            other => other,
        };
        let lu = lu.map_err(|error| match error {
            NoStructure::TooLarge => NoFactor::Singular,
            NoStructure::TimeIsUp => NoFactor::TimeIsUp,
        })?;
        let n = w.row_count();
        let (ones, penalties) = (vec![Matrix::identity(); n], vec![Matrix::zeros(); n]);
        Ok(Self::Blocks(Box::new(Blocks { w, lu, ones, penalties, clock })))
    }

    /// Factorises with these penalties.
    pub fn factorize(&mut self, penalties: &[f64]) -> Result<(), NoFactor> {
        match self {
            Self::Blocks(blocks) => blocks.factorize(penalties),
            Self::Supernodes(supernodes) => supernodes.factorize(penalties),
        }
    }

    /// Overwrites the right-hand side `x` with the solution.
    pub fn solve(&mut self, x: &mut [Vector<D>]) {
        match self {
            Self::Blocks(blocks) => blocks.lu.solve(x),
            Self::Supernodes(supernodes) => supernodes.solve(x),
        }
    }
}

/// LU factor by blocks.
pub(crate) struct Blocks<'a, const D: usize> {
    w: &'a BlockMatrix<D>,
    lu: BlockLu<D>,
    ones: Vec<Matrix<D>>,
    penalties: Vec<Matrix<D>>,
    clock: Clock,
}

impl<const D: usize> Blocks<'_, D> {
    fn factorize(&mut self, penalties: &[f64]) -> Result<(), NoFactor> {
        for (block, penalty) in self.penalties.iter_mut().zip(penalties) {
            *block = Matrix::identity() * *penalty;
        }
        self.lu.factorize(self.w, 0.0, &self.ones, &self.penalties, self.clock).map_err(|error| match error {
            NoBlockFactor::SmallPivot => NoFactor::Singular,
            NoBlockFactor::TimeIsUp => NoFactor::TimeIsUp,
        })
    }
}

/// Supernodal Cholesky factor.
pub(crate) struct Supernodes<const D: usize> {
    /// The lower triangle of W by columns, and the places of its diagonal.
    w: Vec<f64>,
    diagonal: Vec<usize>,
    penalised: Vec<f64>,
    factor: SparseFactor,
    memory: MemBuffer,
    flat: Vec<f64>,
    clock: Clock,
}

impl<const D: usize> Supernodes<D> {
    fn new(w: &BlockMatrix<D>, clock: Clock) -> Result<Self, NoFactor> {
        let n = w.row_count() * D;
        let (mut starts, mut rows, mut values, mut diagonal) = (vec![0], Vec::new(), Vec::new(), Vec::new());
        for i in 0..w.row_count() {
            for column in 0..D {
                diagonal.push(values.len());
                // By symmetry the blocks below the diagonal are those of the row, transposed.
                for (j, block) in w.row(i).filter(|&(j, _)| j >= i) {
                    for row in (if j == i { column } else { 0 })..D {
                        rows.push(j * D + row);
                        values.push(block[(column, row)]);
                    }
                }
                starts.push(rows.len());
            }
        }
        let pattern = SymbolicSparseColMat::new_checked(n, n, starts, None, rows);
        let factor = SparseFactor::cholesky(pattern, clock)?;
        let memory = MemBuffer::try_new(factor.scratch(1)).map_err(|_| NoFactor::Singular)?;
        Ok(Self {
            clock,
            penalised: vec![0.0; values.len()],
            w: values,
            flat: vec![0.0; n],
            diagonal,
            factor,
            memory,
        })
    }

    fn factorize(&mut self, penalties: &[f64]) -> Result<(), NoFactor> {
        self.penalised.copy_from_slice(&self.w);
        for (k, &place) in self.diagonal.iter().enumerate() {
            self.penalised[place] += penalties[k / D];
        }
        self.factor.factorize(&self.penalised, self.clock)
    }

    fn solve(&mut self, x: &mut [Vector<D>]) {
        for (flat, x) in self.flat.chunks_exact_mut(D).zip(&*x) {
            flat.copy_from_slice(x.as_slice());
        }
        self.factor.solve(&mut self.flat, &mut self.memory);
        for (flat, x) in self.flat.chunks_exact(D).zip(x) {
            x.copy_from_slice(flat);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_factors_solve_the_equations() {
        let n = 30;
        let block = |i: usize, j: usize| {
            Matrix::<3>::from_fn(|a, b| ((i * 3 + a + 1) as f64 * (j * 3 + b + 1) as f64).sin())
        };
        let mut w = BlockMatrix::<3>::default();
        for i in 0..n {
            let mut row = vec![(i, block(i, i) + block(i, i).transpose() + Matrix::identity() * 20.0)];
            for j in [(i + 1) % n, (i + n - 1) % n, (i + 7) % n, (i + n - 7) % n] {
                row.push((j, block(i, j)));
            }
            row.sort_by_key(|&(j, _)| j);
            w.push_row(row);
        }
        assert!(w.is_symmetric());
        let exact: Vec<Vector<3>> =
            (0..n).map(|i| Vector::from_fn(|k, _| ((i * 3 + k) as f64).cos())).collect();
        let penalties: Vec<f64> = (0..n).map(|i| i as f64).collect();
        let clock = Clock::new(None);
        let supernodes = Supernodes::new(&w, clock).expect("small");
        for mut factor in
            [Penalised::new(&w, clock).expect("small"), Penalised::Supernodes(Box::new(supernodes))]
        {
            let mut x: Vec<Vector<3>> =
                (0..n).map(|i| w.row_times(i, &exact) + exact[i] * penalties[i]).collect();
            assert_eq!(factor.factorize(&penalties), Ok(()));
            factor.solve(&mut x);
            for (x, e) in x.iter().zip(&exact) {
                assert!((x - e).norm() < 1e-12);
            }
        }
    }

    #[test]
    fn matrix_with_one_skew_block_is_not_symmetric() {
        let mut w = BlockMatrix::<2>::default();
        w.push_row([(0, Matrix::identity()), (1, Matrix::identity() * 0.5)]);
        w.push_row([(0, Matrix::identity() * 0.5001), (1, Matrix::identity())]);
        assert!(!w.is_symmetric());
    }
}
