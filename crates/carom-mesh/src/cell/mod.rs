//! Reference cells: shape functions, their gradients, node coordinates and facets. One file per family.
//!
//! Nodes are numbered as VTK and meshio do: corners, then the middles of edges, of sides, of the cell.

mod hexahedron;
mod line;
mod quadratic;
mod quadrilateral;
mod reference;
mod tetrahedron;
mod triangle;
mod wedge;

use crate::Vector;

pub use reference::{CellKind, Reference};

/// The most nodes any cell has.
pub const MAX_NODES: usize = 27;

/// The most nodes any facet of a cell has.
pub const MAX_FACET_NODES: usize = 9;

impl CellKind {
    /// Every kind, for tests and messages.
    pub const ALL: [CellKind; 14] = [
        CellKind::Line2,
        CellKind::Line3,
        CellKind::Tri3,
        CellKind::Tri6,
        CellKind::Quad4,
        CellKind::Quad8,
        CellKind::Quad9,
        CellKind::Tet4,
        CellKind::Tet10,
        CellKind::Hex8,
        CellKind::Hex20,
        CellKind::Hex27,
        CellKind::Wedge6,
        CellKind::Wedge15,
    ];

    /// The reference cell of this kind.
    #[must_use]
    pub fn reference(self) -> &'static Reference {
        match self {
            CellKind::Line2 => &line::LINE2,
            CellKind::Line3 => &line::LINE3,
            CellKind::Tri3 => &triangle::TRI3,
            CellKind::Tri6 => &triangle::TRI6,
            CellKind::Quad4 => &quadrilateral::QUAD4,
            CellKind::Quad8 => &quadrilateral::QUAD8,
            CellKind::Quad9 => &quadrilateral::QUAD9,
            CellKind::Tet4 => &tetrahedron::TET4,
            CellKind::Tet10 => &tetrahedron::TET10,
            CellKind::Hex8 => &hexahedron::HEX8,
            CellKind::Hex20 => &hexahedron::HEX20,
            CellKind::Hex27 => &hexahedron::HEX27,
            CellKind::Wedge6 => &wedge::WEDGE6,
            CellKind::Wedge15 => &wedge::WEDGE15,
        }
    }

    /// Number of nodes.
    #[must_use]
    pub fn node_count(self) -> usize {
        self.reference().nodes.len()
    }

    /// Dimension of the reference domain.
    #[must_use]
    pub fn dimension(self) -> usize {
        self.reference().dimension
    }

    /// Number of corners: the nodes that come first.
    #[must_use]
    pub fn corner_count(self) -> usize {
        match self {
            CellKind::Line2 | CellKind::Line3 => 2,
            CellKind::Tri3 | CellKind::Tri6 => 3,
            CellKind::Quad4 | CellKind::Quad8 | CellKind::Quad9 | CellKind::Tet4 | CellKind::Tet10 => 4,
            CellKind::Wedge6 | CellKind::Wedge15 => 6,
            CellKind::Hex8 | CellKind::Hex20 | CellKind::Hex27 => 8,
        }
    }

    /// Whether the reference domain is a simplex, of which the first corner is the origin.
    #[must_use]
    pub fn is_simplex(self) -> bool {
        self.dimension() > 1 && self.corner_count() == self.dimension() + 1
    }

    /// Whether the reference domain is a triangle that is swept along a line.
    #[must_use]
    pub fn is_wedge(self) -> bool {
        matches!(self, CellKind::Wedge6 | CellKind::Wedge15)
    }

    /// Whether the shape functions are quadratic, with nodes on the middles of edges.
    #[must_use]
    pub fn is_quadratic(self) -> bool {
        self.reference().degree == 2
    }

    /// The shortest distance between neighbouring nodes along an edge of a cell whose nodes are at `position` [m].
    pub fn smallest_edge<const D: usize>(self, position: &dyn Fn(usize) -> Vector<D>) -> f64 {
        match self {
            CellKind::Line2 => (position(1) - position(0)).norm(),
            CellKind::Line3 => (position(2) - position(0)).norm().min((position(1) - position(2)).norm()),
            _ => {
                let facets = self.reference().facets.iter();
                facets
                    .map(|(kind, nodes)| kind.smallest_edge(&|k| position(nodes[k])))
                    .fold(f64::INFINITY, f64::min)
            }
        }
    }
}

#[cfg(test)]
mod tests {
    //! The contract that every cell passes: a new kind is proved by its line in `CellKind::ALL`.
    use super::*;

    /// A point inside any reference domain.
    const INSIDE: [f64; 3] = [0.21, 0.17, 0.13];

    fn shape(kind: CellKind, xi: &[f64; 3]) -> Vec<f64> {
        let mut n = vec![0.0; kind.node_count()];
        (kind.reference().shape)(xi, &mut n);
        n
    }

    #[test]
    fn shape_functions_are_one_at_their_node_and_zero_at_the_others() {
        for kind in CellKind::ALL {
            for (a, xi) in kind.reference().nodes.iter().enumerate() {
                for (b, n) in shape(kind, xi).into_iter().enumerate() {
                    let expected = if a == b { 1.0 } else { 0.0 };
                    assert!((n - expected).abs() < 1e-15, "{kind:?} N_{b} at node {a}");
                }
            }
        }
    }

    #[test]
    fn shape_functions_are_a_partition_of_unity_and_reproduce_position() {
        for kind in CellKind::ALL {
            let n = shape(kind, &INSIDE);
            assert!((n.iter().sum::<f64>() - 1.0).abs() < 1e-15, "{kind:?}");
            for i in 0..kind.dimension() {
                let x: f64 = n.iter().zip(kind.reference().nodes).map(|(n, p)| n * p[i]).sum();
                assert!((x - INSIDE[i]).abs() < 1e-15, "{kind:?}");
            }
        }
    }

    #[test]
    fn gradients_are_the_derivatives_of_the_shape_functions() {
        let h = 1e-6;
        for kind in CellKind::ALL {
            let mut gradient = vec![[0.0; 3]; kind.node_count()];
            (kind.reference().gradient)(&INSIDE, &mut gradient);
            for i in 0..kind.dimension() {
                let (mut p, mut m) = (INSIDE, INSIDE);
                p[i] += h;
                m[i] -= h;
                let (p, m) = (shape(kind, &p), shape(kind, &m));
                for a in 0..kind.node_count() {
                    let numeric = (p[a] - m[a]) / (2.0 * h);
                    assert!((gradient[a][i] - numeric).abs() < 1e-9, "{kind:?} node {a}");
                }
            }
        }
    }

    /// Reproduces x^i y^j z^k with i + j + k ≤ degree.
    #[test]
    fn shape_functions_reproduce_complete_polynomials_of_their_degree() {
        for kind in CellKind::ALL {
            let n = shape(kind, &INSIDE);
            let (d, degree) = (kind.dimension(), kind.reference().degree as i32);
            let powers = (0..27).map(|m| [m % 3, m / 3 % 3, m / 9]);
            for p in powers.filter(|p| p.iter().sum::<i32>() <= degree && p[d..].iter().all(|&k| k == 0)) {
                let monomial = |x: &[f64; 3]| x[0].powi(p[0]) * x[1].powi(p[1]) * x[2].powi(p[2]);
                let sum: f64 = n.iter().zip(kind.reference().nodes).map(|(n, x)| n * monomial(x)).sum();
                assert!((sum - monomial(&INSIDE)).abs() < 1e-15, "{kind:?} {p:?}");
            }
        }
    }

    /// A plane through the corners of a facet has all its nodes on it and the other nodes of the cell inside.
    #[test]
    fn facets_are_the_sides_of_the_cell_and_turn_outward() {
        for kind in CellKind::ALL.into_iter().filter(|k| k.dimension() > 1) {
            let nodes = kind.reference().nodes;
            let sides = match kind.dimension() {
                _ if kind.is_wedge() => 5,
                _ if kind.is_simplex() => kind.dimension() + 1,
                dimension => 2 * dimension,
            };
            assert_eq!(kind.reference().facets.len(), sides);
            for (facet, local) in kind.reference().facets {
                assert_eq!(facet.node_count(), local.len());
                assert_eq!(facet.dimension() + 1, kind.dimension());
                assert_eq!(facet.is_quadratic(), kind.is_quadratic());
                let x = |a: usize| Vector::<3>::from(nodes[a]);
                let (s, t) = (x(local[1]) - x(local[0]), x(local[local.len() - 1]) - x(local[0]));
                let outward =
                    if kind.dimension() == 2 { Vector::<3>::new(s[1], -s[0], 0.0) } else { s.cross(&t) };
                for a in 0..nodes.len() {
                    let height = outward.dot(&(x(a) - x(local[0])));
                    assert_eq!(height.abs() < 1e-15, local.contains(&a), "{kind:?} node {a}");
                    assert!(height < 1e-15, "{kind:?} node {a} lies outside {local:?}");
                }
            }
        }
    }

    /// The nodes of a facet stand where the reference facet has them, in its order.
    #[test]
    fn nodes_of_facets_are_in_their_order() {
        for kind in CellKind::ALL.into_iter().filter(|k| k.is_quadratic() && k.dimension() > 1) {
            for &(facet, local) in kind.reference().facets {
                let x = |a: usize| Vector::<3>::from(kind.reference().nodes[local[a]]);
                let linear = match facet.corner_count() {
                    2 => CellKind::Line2,
                    3 => CellKind::Tri3,
                    _ => CellKind::Quad4,
                };
                for (a, xi) in facet.reference().nodes.iter().enumerate() {
                    let n = shape(linear, xi);
                    let expected: Vector<3> = n.iter().enumerate().map(|(c, n)| x(c) * *n).sum();
                    assert!((x(a) - expected).norm() < 1e-15, "{kind:?} {local:?} node {a}");
                }
            }
        }
    }

    #[test]
    fn no_cell_has_more_nodes_than_there_is_room_for() {
        assert_eq!(CellKind::ALL.iter().map(|k| k.node_count()).max(), Some(MAX_NODES));
        let facets = CellKind::ALL.iter().flat_map(|k| k.reference().facets);
        assert_eq!(facets.map(|(f, _)| f.node_count()).max(), Some(MAX_FACET_NODES));
    }

    #[test]
    fn the_smallest_edge_lies_between_neighbouring_nodes() {
        for kind in CellKind::ALL {
            let nodes = kind.reference().nodes;
            let edge = if nodes[0][0] == 0.0 { 1.0 } else { 2.0 };
            let expected = if kind.is_quadratic() { 0.5 * edge } else { edge };
            assert_eq!(kind.smallest_edge::<3>(&|a| Vector::<3>::from(nodes[a])), expected, "{kind:?}");
        }
    }
}
