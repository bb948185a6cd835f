use faer::dyn_stack::{MemBuffer, MemStack, StackReq};
use faer::linalg::cholesky::llt::factor::{LltParams, LltRegularization};
use faer::linalg::lu::partial_pivoting::factor::PartialPivLuParams;
use faer::sparse::linalg::SupernodalThreshold;
use faer::sparse::linalg::cholesky::{
    CholeskySymbolicParams, LltRef, SymbolicCholesky, SymbolicCholeskyRaw, SymmetricOrdering,
    factorize_symbolic_cholesky,
};
use faer::sparse::linalg::lu::{LuRef, LuSymbolicParams, NumericLu, SymbolicLu, factorize_symbolic_lu};
use faer::sparse::{SparseColMatRef, SymbolicSparseColMat};
use faer::{Conj, MatMut, Par, Side, Spec};

use crate::clock::Clock;
use crate::speed;

/// Factor of sparse matrices of one pattern: LLᵀ (supernodal) where they are symmetric and positive definite, LU otherwise.
///
/// Ordering and structure are found once; [`SparseFactor::factorize`] renews the values.
pub(crate) struct SparseFactor {
    pattern: SymbolicSparseColMat<usize>,
    kind: Kind,
    size: Size,
}

/// What a factor takes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Size {
    /// Numbers stored. For LU as if no rows were exchanged.
    pub fill: f64,
    /// Multiplications of a factorisation.
    pub work: f64,
}

enum Kind {
    Cholesky { symbolic: SymbolicCholesky<usize>, values: Vec<f64> },
    Lu { symbolic: SymbolicLu<usize>, numeric: NumericLu<usize, f64> },
}

/// Why there is no factor.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum NoFactor {
    /// The matrix has none of the kind asked for, or memory does not suffice.
    Singular,
    /// The time is up, or would be before the factor is ready.
    TimeIsUp,
}

impl SparseFactor {
    /// For symmetric positive definite matrices with this pattern, of which only the lower triangle is read.
    pub fn cholesky(pattern: SymbolicSparseColMat<usize>, clock: Clock) -> Result<Self, NoFactor> {
        clock.check().map_err(|_| NoFactor::TimeIsUp)?;
        let symbolic = cholesky_structure(&pattern)?;
        let (values, size) = (vec![0.0; symbolic.len_val()], size(&symbolic));
        Ok(Self { pattern, kind: Kind::Cholesky { symbolic, values }, size })
    }

    /// For any regular matrices with this pattern.
    pub fn lu(pattern: SymbolicSparseColMat<usize>, clock: Clock) -> Result<Self, NoFactor> {
        clock.check().map_err(|_| NoFactor::TimeIsUp)?;
        let Size { fill, work } = size(&cholesky_structure(&pattern)?);
        let size = Size { fill: 2.0 * fill, work: 2.0 * work };
        let symbolic = factorize_symbolic_lu(pattern.as_ref(), LuSymbolicParams::default())
            .map_err(|_| NoFactor::Singular)?;
        Ok(Self { pattern, kind: Kind::Lu { symbolic, numeric: NumericLu::new() }, size })
    }

    /// What it takes.
    pub fn size(&self) -> Size {
        self.size
    }

    /// Factorises the matrix with these `values`, in the order of the pattern, if there is time for it: once begun it cannot be
    /// cut short.
    pub fn factorize(&mut self, values: &[f64], clock: Clock) -> Result<(), NoFactor> {
        if clock
            .left()
            .is_some_and(|left| left.as_secs_f64() < self.size.work / speed::multiplications_per_second())
        {
            return Err(NoFactor::TimeIsUp);
        }
        let matrix = SparseColMatRef::new(self.pattern.as_ref(), values);
        match &mut self.kind {
            Kind::Cholesky { symbolic, values } => {
                let request = symbolic
                    .factorize_numeric_llt_scratch::<f64>(Par::Seq, Spec::<LltParams, f64>::default());
                let mut memory = MemBuffer::try_new(request).map_err(|_| NoFactor::Singular)?;
                symbolic
                    .factorize_numeric_llt(
                        values,
                        matrix,
                        Side::Lower,
                        LltRegularization::default(),
                        Par::Seq,
                        MemStack::new(&mut memory),
                        Spec::default(),
                    )
                    .map(|_| ())
                    .map_err(|_| NoFactor::Singular)
            }
            Kind::Lu { symbolic, numeric } => {
                let request = symbolic.factorize_numeric_lu_scratch::<f64>(
                    Par::Seq,
                    Spec::<PartialPivLuParams, f64>::default(),
                );
                let mut memory = MemBuffer::try_new(request).map_err(|_| NoFactor::Singular)?;
                let stack = MemStack::new(&mut memory);
                symbolic
                    .factorize_numeric_lu(numeric, matrix, Par::Seq, stack, Spec::default())
                    .map(|_| ())
                    .map_err(|_| NoFactor::Singular)
            }
        }
    }

    /// What solving for `columns` right-hand sides at once needs of memory.
    pub fn scratch(&self, columns: usize) -> StackReq {
        match &self.kind {
            Kind::Cholesky { symbolic, .. } => symbolic.solve_in_place_scratch::<f64>(columns, Par::Seq),
            Kind::Lu { symbolic, .. } => symbolic.solve_in_place_scratch::<f64>(columns, Par::Seq),
        }
    }

    /// Overwrites the right-hand sides in `x`, column after column, with the solutions.
    pub fn solve(&self, x: &mut [f64], memory: &mut MemBuffer) {
        let (rhs, stack) = (columns(x, self.pattern.nrows()), MemStack::new(memory));
        match &self.kind {
            Kind::Cholesky { symbolic, values } => {
                LltRef::new(symbolic, values).solve_in_place_with_conj(Conj::No, rhs, Par::Seq, stack);
            }
            Kind::Lu { symbolic, numeric } => {
                LuRef::new_unchecked(symbolic, numeric).solve_in_place_with_conj(
                    Conj::No,
                    rhs,
                    Par::Seq,
                    stack,
                );
            }
        }
    }

    /// As [`SparseFactor::solve`], with the transposed matrix.
    pub fn solve_transposed(&self, x: &mut [f64], memory: &mut MemBuffer) {
        if let Kind::Lu { symbolic, numeric } = &self.kind {
            let (rhs, stack) = (columns(x, self.pattern.nrows()), MemStack::new(memory));
            LuRef::new_unchecked(symbolic, numeric).solve_transpose_in_place_with_conj(
                Conj::No,
                rhs,
                Par::Seq,
                stack,
            );
        } else {
            self.solve(x, memory);
        }
    }
}

fn columns(x: &mut [f64], rows: usize) -> MatMut<'_, f64> {
    let count = x.len() / rows;
    MatMut::from_column_major_slice_mut(x, rows, count)
}

fn cholesky_structure(pattern: &SymbolicSparseColMat<usize>) -> Result<SymbolicCholesky<usize>, NoFactor> {
    let params = CholeskySymbolicParams {
        supernodal_flop_ratio_threshold: SupernodalThreshold::FORCE_SUPERNODAL,
        ..Default::default()
    };
    factorize_symbolic_cholesky(pattern.as_ref(), Side::Lower, SymmetricOrdering::Amd, params)
        .map_err(|_| NoFactor::Singular)
}

fn size(symbolic: &SymbolicCholesky<usize>) -> Size {
    let fill = symbolic.len_val() as f64;
    let SymbolicCholeskyRaw::Supernodal(structure) = symbolic.raw() else { return Size { fill, work: fill } };
    let work = (0..structure.n_supernodes()).map(|s| {
        let columns = structure.supernode_end()[s] - structure.supernode_begin()[s];
        let rows = columns + structure.supernode(s).pattern().len();
        // Column by column half the square of what is below.
        ((rows as f64).powi(3) - ((rows - columns) as f64).powi(3)) / 6.0
    });
    Size { fill, work: work.sum() }
}
