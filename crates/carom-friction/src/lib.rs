//! Exact Signorini–Coulomb contact on a reduced system, without penalty or regularisation.
//!
//! Find reactions r and relative motions w = W r + q of n contacts that obey the laws, contact by contact. Signorini: w_n ≥
//! 0, r_n ≥ 0, w_n r_n = 0. Coulomb: |r_t| ≤ μ r_n, and r_t = −μ r_n w_t/|w_t| where w_t ≠ 0. W is the Delassus operator,
//! component 0 of a contact vector is normal and the rest tangential, so that one implementation serves D = 1, 2, 3. With w
//! in m and r in N everything called an energy is in J.
//!
//! ```
//! use carom_friction::{BlockMatrix, ContactProblem, SolverKind, StoppingRule, Vector};
//!
//! // A unit mass pressed down with 1 and pushed sideways with 2, friction 0.5: it slips.
//! let problem = ContactProblem::<2> {
//!     w: BlockMatrix::identity(1),
//!     q: vec![Vector::<2>::new(-1.0, 2.0)],
//!     mu: vec![0.5],
//! };
//! let mut r = vec![Vector::zeros()];
//! let report = SolverKind::GaussSeidel.solver().solve(&problem, &mut r, &StoppingRule::default());
//! assert!(report.is_solved());
//! assert!((r[0] - Vector::<2>::new(1.0, -0.5)).norm() < 1e-7);
//! ```
//!
//! Where M and H are at hand rather than W = Hᵀ M⁻¹ H, [`GlobalProblem`] takes them and writes W out only where that is cheaper.
//!
//! References: G. de Saxcé, Z.-Q. Feng, *The bipotential method: a constructive approach to design the complete contact law with
//! friction and improved numerical algorithms*, Math. Comput. Modelling 28 (1998) 225–245; M. Jean, *The non-smooth contact
//! dynamics method*, Comput. Methods Appl. Mech. Engrg. 177 (1999) 235–257.

mod admm;
mod anderson;
mod auto;
mod binary;
mod block_lu;
mod block_matrix;
mod clock;
pub mod cone;
#[cfg(test)]
mod contract;
mod contradiction;
mod dense_lu;
mod equation;
mod gauss_seidel;
mod global;
mod kind;
mod law;
mod local;
mod lu;
mod newton;
mod penalised;
mod problem;
mod projected_gradient;
mod proximal;
mod residual;
mod scaled;
mod schedule;
mod small;
mod solver;
mod solvers;
mod sparse_factor;
mod speed;
mod splitting;
mod stopping;
mod units;
mod uzawa;

pub use admm::Admm;
pub use auto::Auto;
pub use block_matrix::BlockMatrix;
pub use gauss_seidel::{GaussSeidel, Local};
pub use global::{GlobalMethod, GlobalProblem, GlobalReport, SingularMatrix};
pub use kind::SolverKind;
pub use law::{Directional, FrictionLaw, RateAndState, Sliding, StaticKinetic, Weakening};
pub use problem::ContactProblem;
pub use projected_gradient::ProjectedGradient;
pub use proximal::{NewtonAlartCurnier, NewtonNaturalMap, Proximal};
pub use residual::{Criterion, Measure, measure};
pub use solver::FrictionSolver;
pub use stopping::{Sample, SolveReport, SolveStatus, StoppingRule};
pub use uzawa::Uzawa;

/// The sparse matrices of [`GlobalProblem`].
pub use faer::sparse::{SparseColMat, SymbolicSparseColMat, Triplet};

/// A contact vector: component 0 normal, the rest tangential.
pub type Vector<const D: usize> = nalgebra::SVector<f64, D>;
/// A block of the Delassus operator.
pub type Matrix<const D: usize> = nalgebra::SMatrix<f64, D, D>;
