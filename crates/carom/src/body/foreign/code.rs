//! What somebody else's code answers of a body.

use carom_mesh::{Matrix, Vector};

/// A sparse matrix as blocks, each by its row and column of nodes; those of the same place add up.
pub type Blocks<const D: usize> = Vec<(u32, u32, Matrix<D>)>;

/// The law of a body that carom does not know, at displacements u [m], an entry per node. Answers that are not numbers fail the step.
pub trait ForeignCode<const D: usize>: Send + Sync {
    /// E(u) [J], the same wherever the body is moved to or turned.
    fn energy(&self, u: &[Vector<D>]) -> f64;

    /// Writes ∂E/∂u [N] to `out`.
    fn force(&self, u: &[Vector<D>], out: &mut [Vector<D>]);

    /// ∂²E/∂u² [N/m], symmetric; it decides how fast iterations converge, and nothing else. Without one the step fails.
    fn stiffness(&self, u: &[Vector<D>]) -> Option<Blocks<D>>;
}
