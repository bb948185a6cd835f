use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::cholesky::llt::factor::{LltError, LltParams, LltRegularization};
use faer::perm::Perm;
use faer::sparse::linalg::SupernodalThreshold;
use faer::sparse::linalg::cholesky::supernodal::SupernodalLltRef;
use faer::sparse::linalg::cholesky::{
    CholeskySymbolicParams, SymbolicCholesky, SymbolicCholeskyRaw, SymmetricOrdering,
    factorize_symbolic_cholesky,
};
use faer::sparse::{SparseColMatRef, SymbolicSparseColMat};
use faer::{Par, Side, Spec};

use super::triangular::Triangular;
use crate::FemError;

/// The supernodal factorisation of faer, by the lower triangle of a matrix of numbers.
pub(super) struct Cholesky {
    lower: SymbolicSparseColMat<usize>,
    symbolic: SymbolicCholesky<usize>,
    /// The unknown eliminated k-th.
    pub ordering: Vec<usize>,
    /// When an unknown is eliminated.
    pub places: Vec<u32>,
}

impl Cholesky {
    /// Finds the structure of the factor of matrices whose columns have these `rows`, from the diagonal on. The unknowns are eliminated in this
    /// `order`, or in that of AMD.
    ///
    /// # Errors
    /// If that fails, in practice for lack of memory.
    pub fn new(
        column_starts: Vec<usize>,
        rows: Vec<usize>,
        order: Option<Vec<usize>>,
    ) -> Result<Self, FemError> {
        let n = column_starts.len() - 1;
        let lower = SymbolicSparseColMat::new_checked(n, n, column_starts, None, rows);
        let order = order.map(|unknowns| {
            let mut places = vec![0; n];
            unknowns.iter().enumerate().for_each(|(k, &u)| places[u] = k);
            Perm::new_checked(unknowns.into(), places.into(), n)
        });
        let symbolic = factorize_symbolic_cholesky(
            lower.as_ref(),
            Side::Lower,
            order.as_ref().map_or(SymmetricOrdering::Amd, |p| SymmetricOrdering::Custom(p.as_ref())),
            CholeskySymbolicParams {
                supernodal_flop_ratio_threshold: SupernodalThreshold::FORCE_SUPERNODAL,
                ..Default::default()
            },
        )
        .map_err(|e| FemError::Symbolic(format!("{e:?}")))?;
        let ordering = symbolic.perm().map_or_else(|| (0..n).collect(), |p| p.arrays().0.to_vec());
        let mut places = vec![0; n];
        ordering.iter().enumerate().for_each(|(k, &unknown)| places[unknown] = k as u32);
        Ok(Self { lower, symbolic, ordering, places })
    }

    /// Values of the factor.
    pub fn value_count(&self) -> usize {
        self.symbolic.len_val()
    }

    /// Factorises the matrix with these values of the lower triangle into `factor`.
    ///
    /// # Errors
    /// If it is not positive definite.
    pub fn factorize(&self, lower_values: &[f64], factor: &mut dyn Triangular) -> Result<(), FemError> {
        let mut values = vec![0.0; self.symbolic.len_val()];
        let request =
            self.symbolic.factorize_numeric_llt_scratch::<f64>(Par::Seq, Spec::<LltParams, f64>::default());
        self.symbolic
            .factorize_numeric_llt(
                &mut values,
                SparseColMatRef::new(self.lower.as_ref(), lower_values),
                Side::Lower,
                LltRegularization::default(),
                Par::Seq,
                MemStack::new(&mut MemBuffer::new(request)),
                Spec::default(),
            )
            .map_err(|LltError::NonPositivePivot { .. }| FemError::NotPositiveDefinite)?;
        match self.symbolic.raw() {
            SymbolicCholeskyRaw::Supernodal(symbolic) => {
                factor.load(&SupernodalLltRef::new(symbolic, &values), &self.ordering);
            }
            SymbolicCholeskyRaw::Simplicial(_) => unreachable!("supernodes are forced"),
        }
        Ok(())
    }
}
