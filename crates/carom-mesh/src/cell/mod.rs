//! Reference cells: shape functions, their gradients, corner coordinates and facets. One file per family.

mod hexahedron;
mod line;
mod quadrilateral;
mod tetrahedron;
mod triangle;

/// The most nodes any cell has.
pub const MAX_NODES: usize = 8;

/// The kinds of cells that bodies are meshed with, and the facets of these.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum CellKind {
    /// Linear segment, 2 nodes.
    Line2,
    /// Linear triangle, 3 nodes.
    Tri3,
    /// Bilinear quadrilateral, 4 nodes.
    Quad4,
    /// Linear tetrahedron, 4 nodes.
    Tet4,
    /// Trilinear hexahedron, 8 nodes.
    Hex8,
}

/// Where and how a cell lives on its reference domain.
pub struct Reference {
    /// Name as in the case file.
    pub name: &'static str,
    /// Dimension of the reference domain.
    pub dimension: usize,
    /// Reference coordinates of the nodes.
    pub nodes: &'static [[f64; 3]],
    /// Facets with their local nodes, outward normal by the right-hand rule (in 2D: the body is on the left).
    pub facets: &'static [(CellKind, &'static [usize])],
    /// Values N_a(ξ) of the shape functions.
    pub shape: fn(&[f64; 3], &mut [f64]),
    /// Reference gradients ∂N_a/∂ξ.
    pub gradient: fn(&[f64; 3], &mut [[f64; 3]]),
    /// Cell type number of VTK.
    pub vtk_type: u8,
}

impl CellKind {
    /// Every kind, for tests and messages.
    pub const ALL: [CellKind; 5] =
        [CellKind::Line2, CellKind::Tri3, CellKind::Quad4, CellKind::Tet4, CellKind::Hex8];

    /// The reference cell of this kind.
    #[must_use]
    pub fn reference(self) -> &'static Reference {
        match self {
            CellKind::Line2 => &line::LINE2,
            CellKind::Tri3 => &triangle::TRI3,
            CellKind::Quad4 => &quadrilateral::QUAD4,
            CellKind::Tet4 => &tetrahedron::TET4,
            CellKind::Hex8 => &hexahedron::HEX8,
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

    #[test]
    fn facets_have_the_right_kind_and_close_the_cell() {
        for kind in CellKind::ALL {
            let mut seen = vec![0; kind.node_count()];
            for (facet, nodes) in kind.reference().facets {
                assert_eq!(facet.node_count(), nodes.len());
                assert_eq!(facet.dimension() + 1, kind.dimension());
                nodes.iter().for_each(|&a| seen[a] += 1);
            }
            if kind != CellKind::Line2 {
                assert!(seen.iter().all(|&s| s == kind.dimension()), "{kind:?}");
            }
        }
    }
}
