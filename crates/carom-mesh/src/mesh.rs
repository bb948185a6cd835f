use crate::{CellKind, MeshError, Sets, Vector};

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

/// A node that moves as another one does, for ever.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Tie {
    /// The node that follows.
    pub image: u32,
    /// The node that it follows.
    pub master: u32,
}

/// Nodes and the cells that join them, in the reference configuration.
#[derive(Debug, Clone, PartialEq)]
pub struct Mesh<const D: usize> {
    nodes: Vec<Vector<D>>,
    blocks: Vec<CellBlock>,
    ties: Vec<Tie>,
    sets: Sets,
}

impl<const D: usize> Mesh<D> {
    /// A mesh of these nodes [m] and blocks of cells.
    ///
    /// # Errors
    /// If there are no cells, or a cell is not of dimension `D` or refers to an unknown node. Also if a coordinate is not
    /// finite, or a node belongs to no cell.
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
            None => Ok(Self { nodes, blocks, ties: Vec::new(), sets: Sets::default() }),
        }
    }

    /// The same mesh with these ties instead of its own.
    ///
    /// # Errors
    /// If a tie refers to an unknown node, or a node follows two others or one that itself follows another.
    pub fn with_ties(mut self, ties: Vec<Tie>) -> Result<Self, MeshError> {
        let mut follows = vec![false; self.nodes.len()];
        for &Tie { image, master } in &ties {
            let nodes = self.nodes.len();
            if let Some(&node) = [image, master].iter().find(|&&n| n as usize >= nodes) {
                return Err(MeshError::TieOfUnknownNode { node: node as usize, nodes });
            }
            if std::mem::replace(&mut follows[image as usize], true) {
                return Err(MeshError::TiedTwice { node: image as usize });
            }
        }
        // A chain would need its ties in order; whoever makes ties can name the node at its end.
        match ties.iter().find(|t| follows[t.master as usize]) {
            Some(tie) => Err(MeshError::TiedTwice { node: tie.master as usize }),
            None => {
                self.ties = ties;
                Ok(self)
            }
        }
    }

    /// The same mesh with these named sets instead of its own.
    ///
    /// # Errors
    /// If a set refers to a node or cell that is not there. A facet that is none of the mesh's does no harm.
    pub fn with_sets(self, sets: Sets) -> Result<Self, MeshError> {
        let (nodes, cells) = (self.nodes.len(), self.cell_count());
        let facets = sets.facets.iter().map(|(name, set)| (name, set.iter().flatten().max(), nodes, "node"));
        let known =
            sets.nodes.iter().map(|(name, set)| (name, set.iter().max(), nodes, "node")).chain(facets);
        let known = known.chain(sets.cells.iter().map(|(name, set)| (name, set.iter().max(), cells, "cell")));
        for (name, largest, count, what) in known {
            if let Some(&index) = largest.filter(|&&n| n as usize >= count) {
                return Err(MeshError::UnknownInSet {
                    set: name.clone(),
                    what,
                    index: index as usize,
                    count,
                });
            }
        }
        Ok(self.with_sets_unchecked(sets))
    }

    pub(crate) fn with_sets_unchecked(self, sets: Sets) -> Self {
        Self { sets, ..self }
    }

    /// The same mesh elsewhere.
    pub(crate) fn moved(self, to: impl Fn(&Vector<D>) -> Vector<D>) -> Self {
        Self { nodes: self.nodes.iter().map(to).collect(), ..self }
    }

    /// The named sets.
    #[must_use]
    pub fn sets(&self) -> &Sets {
        &self.sets
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

    /// The nodes that move as others do. No node follows two, or one that follows.
    #[must_use]
    pub fn ties(&self) -> &[Tie] {
        &self.ties
    }

    /// The same mesh, if space has `E` dimensions as here: for code that learns the dimension while it runs.
    #[must_use]
    pub fn in_space<const E: usize>(self) -> Option<Mesh<E>> {
        let Self { nodes, blocks, ties, sets } = self;
        let nodes = nodes.iter().map(|x| Vector::from_fn(|i, _| x[i]));
        (D == E).then(|| Mesh { nodes: nodes.collect(), blocks, ties, sets })
    }

    /// For every node the one whose motion it makes: itself, unless it is tied.
    #[must_use]
    pub fn masters(&self) -> Vec<u32> {
        let mut masters: Vec<u32> = (0..self.nodes.len() as u32).collect();
        self.ties.iter().for_each(|t| masters[t.image as usize] = t.master);
        masters
    }

    /// Number of cells in all blocks.
    #[must_use]
    pub fn cell_count(&self) -> usize {
        self.blocks.iter().map(|b| b.cells().len()).sum()
    }

    /// Diameter of the smallest ball around the mean of the nodes that has them all [m]: the diagonal of a box, however it is turned.
    #[must_use]
    pub fn diameter(&self) -> f64 {
        let mean = self.nodes.iter().sum::<Vector<D>>() / self.nodes.len() as f64;
        2.0 * self.nodes.iter().map(|x| (x - mean).norm_squared()).fold(0.0, f64::max).sqrt()
    }

    /// The smallest and the largest coordinates of its nodes [m].
    #[must_use]
    pub fn bounds(&self) -> (Vector<D>, Vector<D>) {
        let first = (self.nodes[0], self.nodes[0]);
        self.nodes.iter().fold(first, |(low, high), x| (low.inf(x), high.sup(x)))
    }

    /// The shortest distance between neighbouring nodes along an edge of a cell [m].
    #[must_use]
    pub fn smallest_edge(&self) -> f64 {
        let of =
            |block: &CellBlock, cell: &[u32]| block.kind.smallest_edge(&|a| self.nodes[cell[a] as usize]);
        let edges = self.blocks.iter().flat_map(|block| block.cells().map(move |cell| of(block, cell)));
        edges.fold(f64::INFINITY, f64::min)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::generate;

    #[test]
    fn ties_that_leave_open_who_moves_are_refused() {
        let mesh = generate::grid([0.0, 0.0], [2.0, 1.0], [2, 1]).expect("valid");
        let tied = |ties: &[(u32, u32)]| {
            let ties = ties.iter().map(|&(image, master)| Tie { image, master }).collect();
            mesh.clone().with_ties(ties).map(|m| m.masters())
        };
        assert_eq!(tied(&[(2, 0), (5, 3)]), Ok(vec![0, 1, 0, 3, 4, 3]));
        let refused = |ties| tied(ties).expect_err("is refused").to_string();
        assert_eq!(refused(&[(2, 6)]), "a tie refers to node 6, but the mesh has 6 nodes (numbered from 0)");
        assert_eq!(
            refused(&[(2, 0), (2, 1)]),
            "node 2 is tied twice; a node can follow one other, which follows none"
        );
        for ties in [&[(2, 0), (2, 1)][..], &[(2, 1), (1, 0)], &[(1, 0), (2, 1)], &[(2, 2)]] {
            assert!(matches!(tied(ties), Err(MeshError::TiedTwice { .. })), "{ties:?}");
        }
    }
}
