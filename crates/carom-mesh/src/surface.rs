use std::collections::BTreeSet;

use crate::cell::MAX_FACET_NODES;
use crate::{CellBlock, CellKind, Mesh, Tie, Vector, tensor};

/// A facet of the boundary.
#[derive(Debug, Clone, PartialEq)]
pub struct Facet {
    /// Kind of the facet, one dimension below that of the cells.
    pub kind: CellKind,
    /// Its nodes, outward normal by the right-hand rule (in 2D: the body is on the left).
    pub nodes: Vec<u32>,
}

impl Facet {
    /// The same facet where the nodes of its mesh are numbered from `first` on.
    #[must_use]
    pub fn numbered_from(&self, first: u32) -> Self {
        Self { kind: self.kind, nodes: self.nodes.iter().map(|node| node + first).collect() }
    }

    /// Its outward normal times its size [m^(D−1)] in the reference configuration; for a curved facet the integral of its normal.
    #[must_use]
    pub fn area_vector<const D: usize>(&self, mesh: &Mesh<D>) -> Vector<D> {
        self.area_vector_at(|n| mesh.nodes()[n])
    }

    /// Its outward unit normal where the nodes of `mesh` are displaced by `u` [m].
    #[must_use]
    pub fn normal<const D: usize>(&self, mesh: &Mesh<D>, u: &[Vector<D>]) -> Vector<D> {
        let area = self.area_vector_at(|n| mesh.nodes()[n] + u[n]);
        area.try_normalize(0.0).unwrap_or(area)
    }

    /// ∫ n dA [m^(D−1)] where its nodes are at `position`. Its rim alone decides: the right-hand normal of the chord in 2D, ½∮ x × dx in 3D.
    #[must_use]
    pub fn area_vector_at<const D: usize>(&self, position: impl Fn(usize) -> Vector<D>) -> Vector<D> {
        let x = |k: usize| position(self.nodes[k] as usize) - position(self.nodes[0] as usize);
        let mut n = Vector::<D>::zeros();
        if D == 2 {
            let t = x(1);
            (n[0], n[1]) = (t[1], -t[0]);
            return n;
        }
        let mut add = |weight: f64, a: usize, b: usize| {
            let product = tensor::cross(&x(a), &x(b));
            (0..D).for_each(|i| n[i] += 0.5 * weight * product[i]);
        };
        for (edge, nodes) in self.kind.reference().facets {
            // x × dx of the line through two or three nodes, integrated exactly.
            if edge.is_quadratic() {
                add(-1.0 / 3.0, nodes[0], nodes[1]);
                add(4.0 / 3.0, nodes[0], nodes[2]);
                add(4.0 / 3.0, nodes[2], nodes[1]);
            } else {
                add(1.0, nodes[0], nodes[1]);
            }
        }
        n
    }
}

/// The boundary of a mesh: the facets that belong to one cell only, less those of sides that are tied to one another.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Surface {
    facets: Vec<Facet>,
    nodes: Vec<u32>,
    ties: Vec<Tie>,
}

impl Surface {
    /// The boundary of `mesh`, facets in the order of its cells.
    #[must_use]
    pub fn of<const D: usize>(mesh: &Mesh<D>) -> Self {
        let all = || mesh.blocks().iter().flat_map(facets_of_cells);
        let count = mesh.blocks().iter().map(|b| b.cells().len() * b.kind.reference().facets.len()).sum();
        // Most facets of a large mesh are inside: they are compared, and nothing is made of them.
        let mut keys: Vec<(FacetKey, u32)> = Vec::with_capacity(count);
        keys.extend(all().zip(0..).map(|((_, nodes), number)| (key(nodes), number)));
        keys.sort_unstable();
        let mut numbers: Vec<u32> =
            keys.chunk_by(|a, b| a.0 == b.0).filter(|same| same.len() == 1).map(|same| same[0].1).collect();
        drop(keys);
        numbers.sort_unstable();
        let mut next = numbers.into_iter().peekable();
        let outside = all().zip(0..).filter(|&(_, number)| next.next_if_eq(&number).is_some());
        let boundary: Vec<(FacetKey, Facet)> = outside
            .map(|((kind, nodes), _)| (key(nodes.clone()), Facet { kind, nodes: nodes.collect() }))
            .collect();
        let tied = tied_facets(mesh, &boundary);
        let free = boundary.into_iter().filter(|(key, _)| !tied.contains(key));
        let mut facets = Vec::new();
        facets.extend(free.map(|(_, facet)| facet));
        Self::of_facets(facets, mesh.ties())
    }

    /// The part of this surface whose facets pass `keep`.
    #[must_use]
    pub fn part(&self, keep: impl Fn(&Facet) -> bool) -> Self {
        Self::of_facets(self.facets.iter().filter(|f| keep(f)).cloned().collect(), &self.ties)
    }

    /// The surface of these facets; of the ties those between its nodes count.
    #[must_use]
    pub fn of_facets(facets: Vec<Facet>, ties: &[Tie]) -> Self {
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

/// The nodes of a facet, ascending, and numbers that no node has after them.
type FacetKey = [u32; MAX_FACET_NODES];

fn key(nodes: impl Iterator<Item = u32>) -> FacetKey {
    let mut key = [u32::MAX; MAX_FACET_NODES];
    key.iter_mut().zip(nodes).for_each(|(own, node)| *own = node);
    key.sort_unstable();
    key
}

/// Every facet of every cell of a block: its kind and its nodes.
fn facets_of_cells(
    block: &CellBlock,
) -> impl Iterator<Item = (CellKind, impl Iterator<Item = u32> + Clone + '_)> {
    block.cells().flat_map(|cell| {
        let of_cell = block.kind.reference().facets.iter();
        of_cell.map(move |&(kind, local)| (kind, local.iter().map(move |&a| cell[a])))
    })
}

/// The facets, by their sorted nodes, that lie on a tied side: those of images only and the ones they coincide with.
fn tied_facets<const D: usize>(mesh: &Mesh<D>, boundary: &[(FacetKey, Facet)]) -> BTreeSet<FacetKey> {
    let mut tied = BTreeSet::new();
    if mesh.ties().is_empty() {
        return tied;
    }
    let masters = mesh.masters();
    let there: BTreeSet<&FacetKey> = boundary.iter().map(|(own, _)| own).collect();
    for (own, facet) in boundary {
        if facet.nodes.iter().all(|&n| masters[n as usize] != n) {
            let opposite = key(facet.nodes.iter().map(|&n| masters[n as usize]));
            if there.contains(&opposite) {
                tied.extend([*own, opposite]);
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

    #[test]
    fn area_vectors_of_a_closed_surface_point_outward_and_sum_to_zero() {
        let grid = generate::grid([0.0; 3], [1.0, 2.0, 3.0], [1, 2, 1]).expect("valid");
        let centre = crate::Vector::from([0.5, 1.0, 1.5]);
        let surface = Surface::of(&grid);
        let mut total = 0.0;
        for facet in surface.facets() {
            let area = facet.area_vector(&grid);
            assert!(area.dot(&(grid.nodes()[facet.nodes[0] as usize] - centre)) > 0.0);
            total += area.norm();
        }
        assert!((total - 22.0).abs() < 1e-12);
        let sum: crate::Vector<3> = surface.facets().iter().map(|f| f.area_vector(&grid)).sum();
        assert!(sum.norm() < 1e-12);
    }

    /// Bent edges: the facets of a cell still close it, and the vector is ∫ t₁ × t₂ dξ dη by 3 × 3 Gauss points, which are exact.
    #[test]
    fn area_vectors_of_curved_facets_are_the_integral_of_the_normal() {
        for kind in [CellKind::Tet10, CellKind::Hex20, CellKind::Hex27, CellKind::Wedge15] {
            let node = |(a, x): (usize, &[f64; 3])| {
                Vector::<3>::from(*x) + Vector::from_fn(|i, _| 0.1 * ((3 * a + i) as f64).sin())
            };
            let nodes: Vec<Vector<3>> = kind.reference().nodes.iter().enumerate().map(node).collect();
            let block = crate::CellBlock { kind, connectivity: (0..nodes.len() as u32).collect() };
            let mesh = Mesh::new(nodes, vec![block]).expect("valid");
            let surface = Surface::of(&mesh);
            let sum: Vector<3> = surface.facets().iter().map(|f| f.area_vector(&mesh)).sum();
            assert!(sum.norm() < 1e-14, "{kind:?}");
            for facet in surface.facets().iter().filter(|f| f.kind.corner_count() == 4) {
                let mut integral = Vector::<3>::zeros();
                let points = [(-0.6_f64.sqrt(), 5.0 / 9.0), (0.0, 8.0 / 9.0), (0.6_f64.sqrt(), 5.0 / 9.0)];
                for ((xi, v), (eta, w)) in points.iter().flat_map(|&p| points.map(|q| (p, q))) {
                    let mut g = [[0.0; 3]; 9];
                    (facet.kind.reference().gradient)(&[xi, eta, 0.0], &mut g);
                    let tangent = |k: usize| -> Vector<3> {
                        facet.nodes.iter().zip(&g).map(|(&n, g)| mesh.nodes()[n as usize] * g[k]).sum()
                    };
                    integral += tangent(0).cross(&tangent(1)) * (v * w);
                }
                assert!((integral - facet.area_vector(&mesh)).norm() < 1e-14, "{kind:?}");
            }
        }
    }
}
