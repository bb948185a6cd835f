use rayon::prelude::*;

use crate::{Matrix, Vector};

/// Blocks from which threads share a product, and rows that one takes at least: a product of so many blocks takes longer than to wake another thread.
const MANY: usize = 1 << 16;
const ROWS: usize = 256;

/// A square sparse matrix of D × D blocks, row by row; a dense one is the special case with every block stored.
#[derive(Debug, Clone, PartialEq)]
pub struct BlockMatrix<const D: usize> {
    starts: Vec<usize>,
    columns: Vec<u32>,
    blocks: Vec<Matrix<D>>,
    diagonal: Vec<usize>,
}

impl<const D: usize> Default for BlockMatrix<D> {
    fn default() -> Self {
        Self { starts: vec![0], columns: Vec::new(), blocks: Vec::new(), diagonal: Vec::new() }
    }
}

impl<const D: usize> BlockMatrix<D> {
    /// The identity with `rows` block rows.
    #[must_use]
    pub fn identity(rows: usize) -> Self {
        let mut matrix = Self::default();
        for i in 0..rows {
            matrix.push_row(std::iter::once((i, Matrix::identity())));
        }
        matrix
    }

    /// Forgets all rows but keeps the memory.
    pub fn clear(&mut self) {
        self.starts.truncate(1);
        self.columns.clear();
        self.blocks.clear();
        self.diagonal.clear();
    }

    /// Appends the next row: its blocks by ascending column, the diagonal one among them.
    ///
    /// # Panics
    /// If the diagonal block is missing.
    pub fn push_row(&mut self, row: impl IntoIterator<Item = (usize, Matrix<D>)>) {
        let i = self.row_count();
        for (column, block) in row {
            if column == i {
                self.diagonal.push(self.blocks.len());
            }
            self.columns.push(column as u32);
            self.blocks.push(block);
        }
        assert_eq!(self.diagonal.len(), i + 1, "row {i} of a contact problem needs its diagonal block, once");
        self.starts.push(self.blocks.len());
    }

    /// Number of block rows.
    #[must_use]
    pub fn row_count(&self) -> usize {
        self.starts.len() - 1
    }

    /// Number of stored blocks.
    #[must_use]
    pub fn block_count(&self) -> usize {
        self.blocks.len()
    }

    /// The diagonal block of row `i`.
    #[must_use]
    pub fn diagonal(&self, i: usize) -> &Matrix<D> {
        &self.blocks[self.diagonal[i]]
    }

    /// The block in row `i` and column `j`, if it is stored.
    #[must_use]
    pub fn block(&self, i: usize, j: usize) -> Option<&Matrix<D>> {
        let row = self.starts[i]..self.starts[i + 1];
        let place = self.columns[row.clone()].binary_search(&(j as u32)).ok()?;
        Some(&self.blocks[row.start + place])
    }

    /// The blocks of row `i` with their columns.
    pub fn row(&self, i: usize) -> impl ExactSizeIterator<Item = (usize, &Matrix<D>)> {
        let range = self.starts[i]..self.starts[i + 1];
        self.columns[range.clone()].iter().map(|&c| c as usize).zip(&self.blocks[range])
    }

    /// Multiplies the components of row `i` and of column `i` by `factors`.
    pub fn scale(&mut self, i: usize, factors: &Vector<D>) {
        for k in self.starts[i]..self.starts[i + 1] {
            self.blocks[k] = Matrix::from_diagonal(factors) * self.blocks[k];
        }
        for row in 0..self.row_count() {
            let columns = self.starts[row]..self.starts[row + 1];
            if let Ok(k) = self.columns[columns.clone()].binary_search(&(i as u32)) {
                self.blocks[columns.start + k] *= Matrix::from_diagonal(factors);
            }
        }
    }

    /// Whether every block is the transpose of its mirror image, but for round-off.
    #[must_use]
    pub fn is_symmetric(&self) -> bool {
        let largest = self.blocks.iter().map(Matrix::amax).fold(0.0, f64::max);
        (0..self.row_count()).all(|i| {
            self.row(i).filter(|&(j, _)| j > i).all(|(j, block)| {
                let row = self.starts[j]..self.starts[j + 1];
                let mirror = self.columns[row.clone()].binary_search(&(i as u32)).map(|k| row.start + k);
                mirror.is_ok_and(|k| (block - self.blocks[k].transpose()).amax() <= 1e-14 * largest)
            })
        })
    }

    /// The columns and blocks of row `i`.
    pub(crate) fn row_mut(&mut self, i: usize) -> (&[u32], &mut [Matrix<D>]) {
        let range = self.starts[i]..self.starts[i + 1];
        (&self.columns[range.clone()], &mut self.blocks[range])
    }

    /// Overwrites what is below the diagonal with the transpose of what is above. The pattern must be symmetric.
    pub(crate) fn mirror_upper(&mut self) {
        // Rows above are taken in ascending order, so that every row below is filled from left to right.
        let mut next = self.starts.clone();
        for i in 0..self.row_count() {
            let diagonal = &mut self.blocks[self.diagonal[i]];
            diagonal.fill_lower_triangle_with_upper_triangle();
            for e in self.diagonal[i] + 1..self.starts[i + 1] {
                let j = self.columns[e] as usize;
                self.blocks[next[j]] = self.blocks[e].transpose();
                next[j] += 1;
            }
        }
    }

    /// Writes what `made` makes of every row times `x` to `out`. Threads share the rows where there are many blocks; every number is made by one of them, by the
    /// same operations whatever their count.
    pub(crate) fn each_row_times(
        &self,
        x: &[Vector<D>],
        out: &mut [Vector<D>],
        made: impl Fn(usize, Vector<D>) -> Vector<D> + Sync,
    ) {
        let write = |(i, out): (usize, &mut Vector<D>)| *out = made(i, self.row_times(i, x));
        if self.is_shared() {
            out.par_iter_mut().enumerate().with_min_len(ROWS).for_each(write);
        } else {
            out.iter_mut().enumerate().for_each(write);
        }
    }

    /// Whether threads share products with it.
    pub(crate) fn is_shared(&self) -> bool {
        self.blocks.len() >= MANY && rayon::current_num_threads() > 1
    }

    /// Row `i` without its diagonal block, times `x`.
    #[inline]
    #[must_use]
    pub fn row_times_others(&self, i: usize, x: &[Vector<D>]) -> Vector<D> {
        let (start, diagonal, end) = (self.starts[i], self.diagonal[i], self.starts[i + 1]);
        self.segment_times(start..diagonal, x) + self.segment_times(diagonal + 1..end, x)
    }

    /// Row `i` times `x`.
    #[inline]
    #[must_use]
    pub fn row_times(&self, i: usize, x: &[Vector<D>]) -> Vector<D> {
        self.segment_times(self.starts[i]..self.starts[i + 1], x)
    }

    #[inline]
    fn segment_times(&self, segment: std::ops::Range<usize>, x: &[Vector<D>]) -> Vector<D> {
        let mut sum = Vector::zeros();
        for (&j, block) in self.columns[segment.clone()].iter().zip(&self.blocks[segment]) {
            sum += block * x[j as usize];
        }
        sum
    }
}
