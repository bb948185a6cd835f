//! Sparse matrices over the graph of the nodes, and their inverses: Cholesky factors and polynomials.

mod abreast;
mod chebyshev;
mod cholesky;
mod control;
mod factor;
mod folding;
mod graph;
mod inverse;
mod last_panel;
mod memory;
mod moved;
mod nodal_matrix;
mod ordering;
mod pieces;
mod real;
mod region;
mod row;
mod rows;
mod scaled;
mod semi_iteration;
mod shared;
mod spectrum;
mod substitution;
mod triangular;

pub use factor::Factor;
pub use graph::NodeGraph;
pub use inverse::Inverse;
pub use nodal_matrix::NodalMatrix;
pub use region::Region;
pub use shared::Sharing;
pub use triangular::Precision;
