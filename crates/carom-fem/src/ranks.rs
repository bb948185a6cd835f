//! Processes that share the cells of a body.
//!
//! Each of the processes, ranks in the words of MPI, has all nodes of a body and some of its cells. What is a sum over cells, it has its part of:
//! forces, energies, masses and stiffnesses. The sum over all ranks is that of the body. Vectors of all nodes are the same everywhere.

use std::fmt::Debug;
use std::sync::Arc;

use carom_mesh::Vector;

use crate::FemError;

/// The processes that share a body. All of them call the same methods in the same order.
pub trait Ranks: Debug + Send + Sync {
    /// Whether this is the one that has what must be counted once.
    fn is_first(&self) -> bool;
    /// Replaces numbers by their sums over all processes, which are the same everywhere.
    fn sum(&self, values: &mut [f64]);
    /// [`Self::sum`] in single precision.
    fn sum_single(&self, values: &mut [f32]);
    /// What solves with matrices of the body.
    fn solver(&self) -> Box<dyn RankSolver>;
}

/// This process's part of a matrix of D × D blocks, row by row.
#[derive(Debug, Clone, Copy)]
pub struct MatrixPart<'a> {
    /// D.
    pub dimension: usize,
    /// Where the entries of every row start, and where the last ones end.
    pub starts: &'a [usize],
    /// The columns of all entries, ascending within a row.
    pub columns: &'a [u32],
    /// Their blocks, column by column.
    pub values: &'a [f64],
}

/// Solves with a symmetric positive definite matrix of which every process has a [part](MatrixPart).
pub trait RankSolver: Debug + Send + Sync {
    /// Takes the matrix, to solve to round-off if it is to be `exact`.
    ///
    /// # Errors
    /// If it is not positive definite.
    fn make(&mut self, part: &MatrixPart<'_>, exact: bool) -> Result<(), FemError>;
    /// Replaces a right-hand side of all nodes by the solution.
    fn solve(&mut self, x: &mut [f64]);
    /// Memory of this process [bytes].
    fn bytes(&self) -> usize;
}

/// The part of a body that this process has.
#[derive(Debug, Clone)]
pub struct Share {
    /// All processes.
    pub ranks: Arc<dyn Ranks>,
    /// Whether a cell is of this one, by its number.
    pub owns: Arc<[bool]>,
}

/// The same processes and the same cells: nobody compares others.
impl PartialEq for Share {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.ranks, &other.ranks) && self.owns == other.owns
    }
}

/// Numbers of all processes together.
pub(crate) trait Summed {
    /// Replaces a vector of all nodes, of which every process has its part, by the whole.
    fn sum_up<const D: usize>(&self, parts: &mut [Vector<D>]);
    /// The sum of a number of every process.
    fn total(&self, part: f64) -> f64;
}

impl Summed for Option<Arc<dyn Ranks>> {
    fn sum_up<const D: usize>(&self, parts: &mut [Vector<D>]) {
        if let Some(ranks) = self {
            ranks.sum(bytemuck::cast_slice_mut(parts));
        }
    }

    fn total(&self, part: f64) -> f64 {
        let mut whole = [part];
        if let Some(ranks) = self {
            ranks.sum(&mut whole);
        }
        whole[0]
    }
}
