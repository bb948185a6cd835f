//! Masses at points, beside that of the volume.

use std::sync::Arc;

use crate::sparse::NodalMatrix;

/// A mass at a point that moves as nodes do: at Σ w x.
#[derive(Debug, Clone, PartialEq)]
pub struct PointMass {
    /// Mass [kg].
    pub mass: f64,
    /// Nodes and weights w, which add up to one.
    pub stencil: Vec<(u32, f64)>,
}

impl PointMass {
    /// The nodes that couple by it.
    pub(crate) fn pairs(&self) -> impl Iterator<Item = (u32, u32)> {
        self.stencil.iter().flat_map(|a| self.stencil.iter().map(move |b| (a.0, b.0)))
    }
}

/// A mass matrix [kg] with m w ⊗ w of masses at points.
pub(crate) fn with_points(mass: NodalMatrix<f64>, points: &[PointMass]) -> NodalMatrix<f64> {
    if points.is_empty() {
        return mass;
    }
    let terms: Vec<(u32, u32, f64)> = points
        .iter()
        .flat_map(|PointMass { mass, stencil }| {
            let pairs = stencil.iter().flat_map(|a| stencil.iter().map(move |b| (a, b)));
            pairs.map(move |(a, b)| (a.0, b.0, mass * a.1 * b.1))
        })
        .collect();
    let graph = Arc::new(mass.graph().extended(terms.iter().map(|&(i, j, _)| (i, j))));
    let mut all = NodalMatrix::filled(&graph, 0.0);
    for row in 0..graph.node_count() {
        for (entry, column) in mass.graph().row(row) {
            all.values[graph.entry(row as u32, column as u32)] += mass.values[entry];
        }
    }
    for (i, j, value) in terms {
        all.values[graph.entry(i, j)] += value;
    }
    all
}
