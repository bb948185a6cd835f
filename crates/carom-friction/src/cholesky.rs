use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::cholesky::llt::factor::LltRegularization;
use faer::sparse::linalg::SupernodalThreshold;
use faer::sparse::linalg::cholesky::{
    CholeskySymbolicParams, LltRef, SymbolicCholesky, SymmetricOrdering, factorize_symbolic_cholesky,
};
use faer::sparse::{SparseColMatRef, SymbolicSparseColMat};
use faer::{Conj, MatMut, Par, Side, Spec};

use crate::{BlockMatrix, Vector};

/// Supernodal Cholesky factor of W + diag for a symmetric W: ten times as fast to renew as [`crate::block_lu::BlockLu`] where
/// there are 10⁴ contacts, slower where there are hundreds.
pub(crate) struct Cholesky<const D: usize> {
    lower: SymbolicSparseColMat<usize>,
    symbolic: SymbolicCholesky<usize>,
    /// The lower triangle of W by columns, and the places of its diagonal.
    w: Vec<f64>,
    diagonal: Vec<usize>,
    shifted: Vec<f64>,
    factor: Vec<f64>,
    memory: MemBuffer,
    flat: Vec<f64>,
}

impl<const D: usize> Cholesky<D> {
    /// Orders the unknowns (AMD) and finds the structure of the factor; None if memory does not suffice.
    pub fn new(w: &BlockMatrix<D>) -> Option<Self> {
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
        let lower = SymbolicSparseColMat::new_checked(n, n, starts, None, rows);
        let parameters = CholeskySymbolicParams {
            supernodal_flop_ratio_threshold: SupernodalThreshold::FORCE_SUPERNODAL,
            ..Default::default()
        };
        let symbolic =
            factorize_symbolic_cholesky(lower.as_ref(), Side::Lower, SymmetricOrdering::Amd, parameters)
                .ok()?;
        let request =
            symbolic
                .factorize_numeric_llt_scratch::<f64>(Par::Seq, Spec::default())
                .or(symbolic.solve_in_place_scratch::<f64>(1, Par::Seq));
        Some(Self {
            shifted: vec![0.0; values.len()],
            factor: vec![0.0; symbolic.len_val()],
            memory: MemBuffer::try_new(request).ok()?,
            flat: vec![0.0; n],
            w: values,
            lower,
            symbolic,
            diagonal,
        })
    }

    /// Factorises W + diag, with the number `diagonal[i]` on the diagonal of contact i; whether that is positive definite.
    pub fn factorize(&mut self, diagonal: impl Fn(usize) -> f64) -> bool {
        self.shifted.copy_from_slice(&self.w);
        for (k, &place) in self.diagonal.iter().enumerate() {
            self.shifted[place] += diagonal(k / D);
        }
        let matrix = SparseColMatRef::new(self.lower.as_ref(), &self.shifted);
        let memory = MemStack::new(&mut self.memory);
        self.symbolic
            .factorize_numeric_llt(
                &mut self.factor,
                matrix,
                Side::Lower,
                LltRegularization::default(),
                Par::Seq,
                memory,
                Spec::default(),
            )
            .is_ok()
    }

    /// Overwrites the right-hand side `x` with the solution.
    pub fn solve(&mut self, x: &mut [Vector<D>]) {
        for (flat, x) in self.flat.chunks_exact_mut(D).zip(&*x) {
            flat.copy_from_slice(x.as_slice());
        }
        let rows = self.flat.len();
        LltRef::new(&self.symbolic, &self.factor).solve_in_place_with_conj(
            Conj::No,
            MatMut::from_column_major_slice_mut(&mut self.flat, rows, 1),
            Par::Seq,
            MemStack::new(&mut self.memory),
        );
        for (flat, x) in self.flat.chunks_exact(D).zip(x) {
            x.copy_from_slice(flat);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Matrix;

    #[test]
    fn solution_satisfies_the_equations() {
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
        let mut x: Vec<Vector<3>> = (0..n).map(|i| w.row_times(i, &exact) + exact[i] * i as f64).collect();
        let mut cholesky = Cholesky::new(&w).expect("small");
        assert!(cholesky.factorize(|i| i as f64));
        cholesky.solve(&mut x);
        for (x, e) in x.iter().zip(&exact) {
            assert!((x - e).norm() < 1e-12);
        }
        assert!(!cholesky.factorize(|_| -100.0));
    }
}
