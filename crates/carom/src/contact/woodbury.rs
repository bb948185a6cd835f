//! The compliance of some nodes with more stiffness between them than K̄ has.

use carom_mesh::Matrix;
use faer::linalg::matmul::matmul;
use faer::linalg::solvers::Solve;
use faer::{Accum, Mat, MatRef, Par};

/// Ĝ, the stiffness that K̄ lacks, and (I + C Ĝ)⁻¹ C, with C the compliance of the nodes by K̄ alone.
///
/// Ĝ is zero but between few of the nodes, Q. With M = I + Ĝ_QQ C_QQ, (I + C Ĝ)⁻¹ C = C − C_:Q M⁻¹ Ĝ_QQ C_Q: (Woodbury).
#[derive(Debug)]
pub(super) struct Woodbury<const D: usize> {
    /// Blocks of Ĝ that add up, by the places of their nodes.
    blocks: Vec<(u32, u32, Matrix<D>)>,
    /// The places of Q, ascending.
    stiffened: Vec<u32>,
    /// Ĝ_QQ.
    stiffness: Mat<f64>,
    /// (I + C Ĝ)⁻¹ C; empty where Ĝ is zero.
    compliance: Mat<f64>,
}

impl<const D: usize> Default for Woodbury<D> {
    fn default() -> Self {
        Self { blocks: Vec::new(), stiffened: Vec::new(), stiffness: Mat::new(), compliance: Mat::new() }
    }
}

impl<const D: usize> Woodbury<D> {
    /// Whether Ĝ is more than nothing.
    pub fn is_needed(&self) -> bool {
        self.compliance.nrows() > 0
    }

    /// Forgets all stiffness.
    pub fn clear(&mut self) {
        *self = Self::default();
    }

    /// Adds a block to Ĝ, which [`Self::make`] makes use of.
    pub fn add(&mut self, (row, column): (usize, usize), block: Matrix<D>) {
        self.blocks.push((row as u32, column as u32, block));
    }

    /// The blocks of Ĝ larger than `least` [N/m], none if there are none.
    fn collect(&mut self, least: f64) {
        self.blocks.sort_by_key(|&(row, column, _)| (row, column));
        self.blocks.dedup_by(|next, kept| {
            let same = (next.0, next.1) == (kept.0, kept.1);
            if same {
                kept.2 += next.2;
            }
            same
        });
        self.blocks.retain(|(_, _, block)| block.amax() > least);
        self.stiffened.clear();
        self.stiffened.extend(self.blocks.iter().flat_map(|&(row, column, _)| [row, column]));
        self.stiffened.sort_unstable();
        self.stiffened.dedup();
    }

    /// Makes use of the blocks added since it was cleared: those larger than `least` [N/m]. `block` is C between the nodes at two of so many places.
    pub fn make(&mut self, count: usize, least: f64, block: impl Fn(usize, usize) -> Option<Matrix<D>>) {
        self.collect(least);
        if self.stiffened.is_empty() {
            self.clear();
            return;
        }
        let mut compliance = Mat::zeros(count * D, count * D);
        for column in 0..count {
            for row in 0..count {
                if let Some(block) = block(row, column) {
                    put(&mut compliance, (row, column), &block);
                }
            }
        }
        let size = self.stiffened.len() * D;
        let mut stiffness = Mat::zeros(size, size);
        let place = |node: u32| self.stiffened.binary_search(&node).unwrap_or_default();
        for (row, column, block) in &self.blocks {
            put(&mut stiffness, (place(*row), place(*column)), block);
        }
        let rows = Mat::from_fn(size, count * D, |i, j| compliance[(self.unknown(i), j)]);
        let among = Mat::from_fn(size, size, |i, j| rows[(i, self.unknown(j))]);
        let mut system = Mat::identity(size, size);
        matmul(&mut system, Accum::Add, &stiffness, &among, 1.0, Par::Seq);
        let mut less = Mat::zeros(size, count * D);
        matmul(&mut less, Accum::Replace, &stiffness, &rows, 1.0, Par::Seq);
        system.partial_piv_lu().solve_in_place(&mut less);
        matmul(&mut compliance, Accum::Add, rows.transpose(), &less, -1.0, Par::Seq);
        (self.stiffness, self.compliance) = (stiffness, compliance);
        self.blocks.clear();
    }

    /// The unknown of all nodes that is the k-th of Q.
    fn unknown(&self, k: usize) -> usize {
        self.stiffened[k / D] as usize * D + k % D
    }

    /// The block of (I + C Ĝ)⁻¹ C between the nodes at two places.
    pub fn block(&self, row: usize, column: usize) -> Matrix<D> {
        Matrix::from_fn(|i, j| self.compliance[(row * D + i, column * D + j)])
    }

    /// (I + C Ĝ)⁻¹ C.
    pub fn compliance(&self) -> MatRef<'_, f64> {
        self.compliance.as_ref()
    }

    /// (I + C Ĝ)⁻¹ C x.
    pub fn yields(&self, x: &[f64]) -> Vec<f64> {
        product(self.compliance.as_ref(), x)
    }

    /// Ĝ x.
    pub fn resists(&self, x: &[f64]) -> Vec<f64> {
        let own: Vec<f64> = (0..self.stiffness.ncols()).map(|k| x[self.unknown(k)]).collect();
        let mut all = vec![0.0; x.len()];
        let resisted = product(self.stiffness.as_ref(), &own);
        resisted.into_iter().enumerate().for_each(|(k, y)| all[self.unknown(k)] = y);
        all
    }
}

/// A x.
fn product(a: MatRef<'_, f64>, x: &[f64]) -> Vec<f64> {
    let mut y = vec![0.0; a.nrows()];
    let (rows, columns) = (y.len(), x.len());
    let out = faer::MatMut::from_column_major_slice_mut(&mut y, rows, 1);
    matmul(out, Accum::Replace, a, MatRef::from_column_major_slice(x, columns, 1), 1.0, Par::Seq);
    y
}

fn put<const D: usize>(matrix: &mut Mat<f64>, (row, column): (usize, usize), block: &Matrix<D>) {
    for j in 0..D {
        (0..D).for_each(|i| matrix[(row * D + i, column * D + j)] = block[(i, j)]);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Three nodes of one body, of which two have a spring between them: the inverse of the sum is that of the whole matrix.
    #[test]
    fn compliance_is_the_inverse_of_both_stiffnesses() {
        let stiffness = Mat::from_fn(6, 6, |i, j| if i == j { 4.0 } else { 1.0 / (1.0 + (i + j) as f64) });
        let alone = stiffness.partial_piv_lu().solve(Mat::<f64>::identity(6, 6));
        let spring = Matrix::<2>::new(3.0, 0.5, 0.5, 1.0);
        let mut woodbury = Woodbury::<2>::default();
        let mut whole = stiffness.clone();
        for (row, column) in [(0, 0), (0, 2), (2, 0), (2, 2)] {
            let block = if row == column { spring } else { -spring };
            // Half of it twice, and a place where it comes to nothing.
            woodbury.add((row, column), block * 0.5);
            woodbury.add((row, column), block * 0.5);
            woodbury.add((1, 1), block);
            woodbury.add((1, 1), -block);
            for i in 0..2 {
                (0..2).for_each(|j| whole[(2 * row + i, 2 * column + j)] += block[(i, j)]);
            }
        }
        let of = |row, column| Some(Matrix::from_fn(|i, j| alone[(2 * row + i, 2 * column + j)]));
        woodbury.make(3, 1e-12, of);
        assert!(woodbury.is_needed());
        assert_eq!(woodbury.stiffened, [0, 2]);
        let inverse = whole.partial_piv_lu().solve(Mat::<f64>::identity(6, 6));
        let x: Vec<f64> = (0..6).map(|k| (k as f64).cos()).collect();
        let expected = product(inverse.as_ref(), &x);
        let resisted = product((&whole - &stiffness).as_ref(), &x);
        for k in 0..6 {
            assert!((woodbury.yields(&x)[k] - expected[k]).abs() < 1e-13);
            assert!((woodbury.resists(&x)[k] - resisted[k]).abs() < 1e-13);
        }
        assert!((woodbury.block(1, 2)[(0, 1)] - inverse[(2, 5)]).abs() < 1e-13);
        woodbury.make(3, 1e-12, of);
        assert!(!woodbury.is_needed(), "all was forgotten");
    }
}
