//! Sparse matrices over the graph of the nodes, and their Cholesky factors.

mod factor;
mod folding;
mod graph;
mod nodal_matrix;
mod ordering;
mod substitution;

pub use factor::Factor;
pub use graph::NodeGraph;
pub use nodal_matrix::NodalMatrix;
