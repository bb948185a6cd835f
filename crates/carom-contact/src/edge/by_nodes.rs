//! Edges by their nodes.

use super::{Edge, Strand};
use crate::{ContactModel, ContactSurface, Pair, Target};

impl ContactSurface {
    /// The edge between two nodes.
    pub(crate) fn edge(&self, [a, b]: [u32; 2]) -> Option<&Edge> {
        let of = |edges: &'_ [Edge], nodes| edges.binary_search_by_key(&nodes, |e| e.nodes).ok();
        [[a, b], [b, a]].into_iter().find_map(|nodes| {
            let sharp = of(&self.edges, nodes).map(|k| &self.edges[k]);
            sharp.or_else(|| of(&self.flat_edges, nodes).map(|k| &self.flat_edges[k]))
        })
    }

    /// The edge from one node to another; a straight one where the surface has none.
    pub(crate) fn strand(&self, nodes: [u32; 2]) -> Strand {
        match self.edge(nodes).map(Edge::strand) {
            Some(strand) if strand.nodes == nodes => strand,
            Some(strand) => strand.reversed(),
            None => Strand::straight(nodes),
        }
    }
}

impl<const D: usize> ContactModel<D> {
    /// The edges of the source and of the target that cross at a site of a pair.
    pub(crate) fn strands(&self, pair: &Pair, [source, target]: [[u32; 2]; 2]) -> [Strand; 2] {
        let own = self.surfaces[pair.source].strand(source);
        let other = match pair.target {
            Target::Surface(t) => self.surfaces[t].strand(target),
            Target::Obstacle(_) => Strand::straight(target),
        };
        [own, other]
    }
}
