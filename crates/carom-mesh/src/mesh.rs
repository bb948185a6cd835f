use crate::{CellKind, MeshError, Vector};

/// Cells of one kind.
#[derive(Debug, Clone, PartialEq)]
pub struct CellBlock {
    /// Kind of all the cells.
    pub kind: CellKind,
    /// Nodes of the cells, one cell after the other, `kind.node_count()` each.
    pub connectivity: Vec<u32>,
}

impl CellBlock {
    /// The nodes of each cell.
    pub fn cells(&self) -> impl ExactSizeIterator<Item = &[u32]> {
        self.connectivity.chunks_exact(self.kind.node_count())
    }
}

/// Nodes and the cells that join them, in the reference configuration.
#[derive(Debug, Clone, PartialEq)]
pub struct Mesh<const D: usize> {
    nodes: Vec<Vector<D>>,
    blocks: Vec<CellBlock>,
}

impl<const D: usize> Mesh<D> {
    /// A mesh of these nodes [m] and blocks of cells.
    ///
    /// # Errors
    /// If there are no cells, a cell is not of dimension `D` or refers to an unknown node, a coordinate is not finite, or
    /// a node belongs to no cell.
    pub fn new(nodes: Vec<Vector<D>>, blocks: Vec<CellBlock>) -> Result<Self, MeshError> {
        if let Some(node) = nodes.iter().position(|x| !x.iter().all(|c| c.is_finite())) {
            return Err(MeshError::NonFiniteNode { node });
        }
        let mut used = vec![false; nodes.len()];
        let mut cell = 0;
        for block in &blocks {
            if block.kind.dimension() != D {
                return Err(MeshError::WrongDimension { kind: block.kind.reference().name, dimension: D });
            }
            for cell_nodes in block.cells() {
                for &node in cell_nodes {
                    *used.get_mut(node as usize).ok_or(MeshError::UnknownNode {
                        cell,
                        node: node as usize,
                        nodes: nodes.len(),
                    })? = true;
                }
                cell += 1;
            }
        }
        if cell == 0 {
            return Err(MeshError::Empty);
        }
        match used.iter().position(|&u| !u) {
            Some(node) => Err(MeshError::OrphanNode { node }),
            None => Ok(Self { nodes, blocks }),
        }
    }

    /// Reference positions of the nodes [m].
    #[must_use]
    pub fn nodes(&self) -> &[Vector<D>] {
        &self.nodes
    }

    /// The blocks of cells.
    #[must_use]
    pub fn blocks(&self) -> &[CellBlock] {
        &self.blocks
    }

    /// Number of cells in all blocks.
    #[must_use]
    pub fn cell_count(&self) -> usize {
        self.blocks.iter().map(|b| b.cells().len()).sum()
    }

    /// Length of the diagonal of the bounding box [m].
    #[must_use]
    pub fn diameter(&self) -> f64 {
        let (mut low, mut high) = (self.nodes[0], self.nodes[0]);
        for x in &self.nodes {
            low = low.inf(x);
            high = high.sup(x);
        }
        (high - low).norm()
    }

    /// Length of the shortest edge between two nodes of a facet of a cell [m].
    #[must_use]
    pub fn smallest_edge(&self) -> f64 {
        let mut smallest = f64::INFINITY;
        for block in &self.blocks {
            for nodes in block.cells() {
                for (_, facet) in block.kind.reference().facets {
                    for k in 0..facet.len() {
                        let a = self.nodes[nodes[facet[k]] as usize];
                        let b = self.nodes[nodes[facet[(k + 1) % facet.len()]] as usize];
                        smallest = smallest.min((a - b).norm());
                    }
                }
            }
        }
        smallest
    }
}
