//! Sparse matrices over the graph of the nodes, and their Cholesky factors.

mod abreast;
mod factor;
mod folding;
mod graph;
mod nodal_matrix;
mod ordering;
mod pieces;
mod real;
mod substitution;
mod triangular;

pub use factor::Factor;
pub use graph::NodeGraph;
pub use nodal_matrix::NodalMatrix;
pub use triangular::Precision;
