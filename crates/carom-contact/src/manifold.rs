use std::collections::BTreeMap;

use crate::ContactSurface;

impl ContactSurface {
    /// The edges that more than two facets share, by their end nodes, ascending: there the surface has no two sides.
    ///
    /// In the plane, where such a place is a node, there are none to be told of: a node with more than two facets is a corner.
    #[must_use]
    pub fn non_manifold_edges(&self) -> Vec<[u32; 2]> {
        let mut facets_at: BTreeMap<[u32; 2], usize> = BTreeMap::new();
        for facet in self.facets.iter().filter(|f| f.kind.dimension() == 2) {
            let corners = &facet.nodes[..facet.kind.corner_count()];
            for (k, &a) in corners.iter().enumerate() {
                let b = corners[(k + 1) % corners.len()];
                *facets_at.entry([a.min(b), a.max(b)]).or_default() += 1;
            }
        }
        facets_at.into_iter().filter(|&(_, count)| count > 2).map(|(edge, _)| edge).collect()
    }
}

#[cfg(test)]
mod tests {
    use carom_mesh::{CellBlock, CellKind, Mesh, Surface, generate};

    use crate::ContactSurface;

    #[test]
    fn cubes_that_share_an_edge_alone_are_told_of() {
        let grid = generate::grid([0.0; 3], [2.0, 2.0, 1.0], [2, 2, 1]).expect("valid");
        let whole = ContactSurface::new(&Surface::of(&grid), 10, &|n| grid.nodes()[n as usize - 10]);
        assert_eq!(whole.non_manifold_edges(), Vec::<[u32; 2]>::new());
        // Two cubes of the chequerboard, with the edge in the middle in common.
        let cells: Vec<&[u32]> = grid.blocks()[0].cells().collect();
        let mut nodes: Vec<u32> = [cells[0], cells[3]].concat();
        nodes.sort_unstable();
        nodes.dedup();
        let number = |n: &u32| nodes.binary_search(n).expect("kept") as u32;
        let connectivity = [cells[0], cells[3]].concat().iter().map(number).collect();
        let kept = nodes.iter().map(|&n| grid.nodes()[n as usize]).collect();
        let block = CellBlock { kind: CellKind::Hex8, connectivity };
        let mesh = Mesh::new(kept, vec![block]).expect("two cubes");
        let at = |n: u32| mesh.nodes()[n as usize - 10];
        let edges = ContactSurface::new(&Surface::of(&mesh), 10, &at).non_manifold_edges();
        assert_eq!(edges.len(), 1);
        for end in edges[0] {
            let x = mesh.nodes()[end as usize - 10];
            assert_eq!((x[0], x[1]), (1.0, 1.0));
        }
    }
}
