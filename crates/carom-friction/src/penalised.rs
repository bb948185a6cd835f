use crate::block_lu::BlockLu;
use crate::cholesky::Cholesky;
use crate::{BlockMatrix, ContactProblem, Matrix, Vector};

/// Factor of W + diag(p_i I) with a penalty p_i [m/N] for every contact.
pub(crate) enum Penalised<'a, const D: usize> {
    /// Of small and of unsymmetric matrices.
    Blocks { w: &'a BlockMatrix<D>, lu: BlockLu<D>, ones: Vec<Matrix<D>>, penalties: Vec<Matrix<D>> },
    /// Of large symmetric ones.
    Supernodes(Cholesky<D>),
}

/// Blocks of a factor from which on supernodes pay.
const MANY_BLOCKS: usize = 60_000;

impl<'a, const D: usize> Penalised<'a, D> {
    /// None if memory does not suffice.
    pub fn new(problem: &'a ContactProblem<D>) -> Option<Self> {
        let w = &problem.w;
        let lu = match BlockLu::new(w, MANY_BLOCKS) {
            None if w.is_symmetric() => return Cholesky::new(w).map(Self::Supernodes),
            None => BlockLu::new(w, usize::MAX)?,
            Some(lu) => lu,
        };
        let n = problem.len();
        Some(Self::Blocks { w, lu, ones: vec![Matrix::identity(); n], penalties: vec![Matrix::zeros(); n] })
    }

    /// Factorises with these penalties; whether the pivots allowed it.
    pub fn factorize(&mut self, penalty: impl Fn(usize) -> f64) -> bool {
        match self {
            Self::Blocks { w, lu, ones, penalties } => {
                for (i, p) in penalties.iter_mut().enumerate() {
                    *p = Matrix::identity() * penalty(i);
                }
                lu.factorize(w, 0.0, ones, penalties).is_ok()
            }
            Self::Supernodes(cholesky) => cholesky.factorize(penalty),
        }
    }

    /// Overwrites the right-hand side `x` with the solution.
    pub fn solve(&mut self, x: &mut [Vector<D>]) {
        match self {
            Self::Blocks { lu, .. } => lu.solve(x),
            Self::Supernodes(cholesky) => cholesky.solve(x),
        }
    }
}
