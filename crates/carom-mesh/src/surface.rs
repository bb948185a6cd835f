use std::collections::{BTreeMap, BTreeSet};

use crate::{CellKind, Mesh, Tie, Vector, tensor};

/// A facet of the boundary.
#[derive(Debug, Clone, PartialEq)]
pub struct Facet {
    /// Kind of the facet, one dimension below that of the cells.
    pub kind: CellKind,
    /// Its nodes, outward normal by the right-hand rule (in 2D: the body is on the left).
    pub nodes: Vec<u32>,
}

impl Facet {
    /// Its outward normal times its size [m^(D−1)] in the reference configuration; for a curved facet that of its corners.
    #[must_use]
    pub fn area_vector<const D: usize>(&self, mesh: &Mesh<D>) -> Vector<D> {
        let x = |k: usize| mesh.nodes()[self.nodes[k] as usize];
        let mut n = Vector::<D>::zeros();
        if D == 2 {
            let t = x(1) - x(0);
            (n[0], n[1]) = (t[1], -t[0]);
        } else {
            // Half the cross product of the diagonals; of two sides for a triangle.
            let last = self.nodes.len() - 1;
            let product = tensor::cross(&(x(2) - x(0)), &(x(last) - x(1)));
            let sign = if last == 2 { -0.5 } else { 0.5 };
            (0..D).for_each(|i| n[i] = sign * product[i]);
        }
        n
    }
}

/// The boundary of a mesh: the facets that belong to one cell only, less those of sides that are tied to one another.
#[derive(Debug, Clone, PartialEq)]
pub struct Surface {
    facets: Vec<Facet>,
    nodes: Vec<u32>,
    ties: Vec<Tie>,
}

impl Surface {
    /// The boundary of `mesh`, facets in the order of its cells.
    #[must_use]
    pub fn of<const D: usize>(mesh: &Mesh<D>) -> Self {
        let mut seen: BTreeMap<Vec<u32>, usize> = BTreeMap::new();
        let mut all = Vec::new();
        for block in mesh.blocks() {
            for cell in block.cells() {
                for &(kind, local) in block.kind.reference().facets {
                    let nodes: Vec<u32> = local.iter().map(|&a| cell[a]).collect();
                    let mut key = nodes.clone();
                    key.sort_unstable();
                    *seen.entry(key.clone()).or_default() += 1;
                    all.push((key, Facet { kind, nodes }));
                }
            }
        }
        all.retain(|(key, _)| seen[key] == 1);
        let tied = tied_facets(mesh, &all);
        let free = all.into_iter().filter(|(key, _)| !tied.contains(key)).map(|(_, facet)| facet);
        Self::of_facets(free.collect(), mesh.ties())
    }

    /// The part of this surface whose facets pass `keep`.
    #[must_use]
    pub fn part(&self, keep: impl Fn(&Facet) -> bool) -> Self {
        Self::of_facets(self.facets.iter().filter(|f| keep(f)).cloned().collect(), &self.ties)
    }

    fn of_facets(facets: Vec<Facet>, ties: &[Tie]) -> Self {
        let mut nodes: Vec<u32> = facets.iter().flat_map(|f| f.nodes.iter().copied()).collect();
        nodes.sort_unstable();
        nodes.dedup();
        let is_on = |n: &u32| nodes.binary_search(n).is_ok();
        let ties = ties.iter().filter(|t| is_on(&t.image) && is_on(&t.master)).copied().collect();
        Self { facets, nodes, ties }
    }

    /// The facets.
    #[must_use]
    pub fn facets(&self) -> &[Facet] {
        &self.facets
    }

    /// The nodes on the boundary, ascending.
    #[must_use]
    pub fn nodes(&self) -> &[u32] {
        &self.nodes
    }

    /// The ties between nodes on the boundary: where a tied side meets a free one.
    #[must_use]
    pub fn ties(&self) -> &[Tie] {
        &self.ties
    }
}

/// The facets, by their sorted nodes, that lie on a tied side: those of images only and the ones they coincide with.
fn tied_facets<const D: usize>(mesh: &Mesh<D>, boundary: &[(Vec<u32>, Facet)]) -> BTreeSet<Vec<u32>> {
    let mut tied = BTreeSet::new();
    if mesh.ties().is_empty() {
        return tied;
    }
    let masters = mesh.masters();
    let there: BTreeSet<&Vec<u32>> = boundary.iter().map(|(key, _)| key).collect();
    for (key, _) in boundary {
        if key.iter().all(|&n| masters[n as usize] != n) {
            let mut opposite: Vec<u32> = key.iter().map(|&n| masters[n as usize]).collect();
            opposite.sort_unstable();
            if there.contains(&opposite) {
                tied.extend([key.clone(), opposite]);
            }
        }
    }
    tied
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::generate;

    #[test]
    fn boundary_of_a_grid_has_its_sides_and_no_more() {
        let mesh = generate::grid([0.0, 0.0], [3.0, 2.0], [3, 2]).expect("valid");
        let surface = Surface::of(&mesh);
        assert_eq!(surface.facets().len(), 10);
        assert_eq!(surface.nodes().len(), 10);
        let mesh = generate::grid([0.0; 3], [1.0; 3], [2, 2, 2]).expect("valid");
        let surface = Surface::of(&mesh);
        assert_eq!(surface.facets().len(), 24);
        assert_eq!(surface.nodes().len(), 26);
    }

    #[test]
    fn sides_that_are_tied_are_no_boundary() {
        for width in 1..4 {
            let mesh = generate::grid([0.0, 0.0], [width as f64, 2.0], [width, 2]).expect("valid");
            let mesh = generate::tie_sides(mesh, 0).expect("alike");
            let surface = Surface::of(&mesh);
            assert_eq!(surface.facets().len(), 2 * width, "top and bottom");
            assert_eq!(surface.nodes().len(), 2 * (width + 1));
            assert_eq!(surface.ties().len(), 2);
        }
        let mesh = generate::grid([0.0; 3], [1.0; 3], [2, 2, 2]).expect("valid");
        let mesh = generate::tie_sides(mesh, 1).expect("alike");
        assert_eq!(Surface::of(&mesh).facets().len(), 16);
    }

    #[test]
    fn facets_of_a_disc_turn_counter_clockwise() {
        let disc = generate::Disc { centre: [1.0, 2.0], radius: 0.5, divisions: 4, rings: None };
        let mesh = disc.quadrilaterals().expect("valid");
        for facet in Surface::of(&mesh).facets() {
            let [a, b] = [0, 1].map(|k| mesh.nodes()[facet.nodes[k] as usize]);
            let (t, x) = (b - a, a - crate::Vector::from([1.0, 2.0]));
            assert!(x[0] * t[1] - x[1] * t[0] > 0.0);
        }
    }
}
