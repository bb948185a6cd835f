use std::ops::Mul;
use std::sync::Arc;

use carom_mesh::{Vector, parallel};

use super::NodeGraph;

/// A matrix with one value per pair of neighbouring nodes: `f64` for mass, a D × D block for stiffness.
#[derive(Debug, Clone)]
pub struct NodalMatrix<T> {
    graph: Arc<NodeGraph>,
    /// One value per entry of the graph.
    pub values: Vec<T>,
}

impl<T: Copy + Sync> NodalMatrix<T> {
    /// The matrix with every entry equal to `value`.
    #[must_use]
    pub fn filled(graph: &Arc<NodeGraph>, value: T) -> Self {
        Self { graph: Arc::clone(graph), values: vec![value; graph.entry_count()] }
    }

    /// The graph of its nodes.
    #[must_use]
    pub fn graph(&self) -> &NodeGraph {
        &self.graph
    }

    /// The graph of its nodes, to share.
    #[must_use]
    pub fn shared_graph(&self) -> &Arc<NodeGraph> {
        &self.graph
    }

    /// Writes A x to `y`.
    pub fn multiply<const D: usize>(&self, x: &[Vector<D>], y: &mut [Vector<D>])
    where
        T: Mul<Vector<D>, Output = Vector<D>>,
    {
        parallel::each_chunk(y, |first, y| {
            for (node, y) in (first..).zip(y) {
                *y = self.row_times(node, x);
            }
        });
    }

    /// The row of a node of A x.
    #[inline]
    pub fn row_times<const D: usize>(&self, node: usize, x: &[Vector<D>]) -> Vector<D>
    where
        T: Mul<Vector<D>, Output = Vector<D>>,
    {
        let (range, neighbours) = self.graph.neighbours(node);
        // Two sums, so that one addition need not wait for the other.
        let (mut even, mut odd) = (Vector::zeros(), Vector::zeros());
        let (values, neighbours) = (self.values[range].chunks_exact(2), neighbours.chunks_exact(2));
        if let ([value], [neighbour]) = (values.remainder(), neighbours.remainder()) {
            even += *value * x[*neighbour as usize];
        }
        for (values, neighbours) in values.zip(neighbours) {
            even += values[0] * x[neighbours[0] as usize];
            odd += values[1] * x[neighbours[1] as usize];
        }
        even + odd
    }
}

impl NodalMatrix<f64> {
    /// The sum of every row.
    #[must_use]
    pub fn row_sums(&self) -> Vec<f64> {
        (0..self.graph.node_count()).map(|n| self.graph.row(n).map(|(e, _)| self.values[e]).sum()).collect()
    }

    /// The sum of every row without signs.
    #[must_use]
    pub fn row_sizes(&self) -> Vec<f64> {
        let size = |n: usize| self.graph.row(n).map(|(e, _)| self.values[e].abs()).sum();
        (0..self.graph.node_count()).map(size).collect()
    }
}
