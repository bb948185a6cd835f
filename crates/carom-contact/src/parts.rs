//! How facets are taken apart for integration: into parts with straight edges, on which multipliers are linear.

use carom_mesh::CellKind;

pub(crate) use carom_mesh::cell::MAX_FACET_NODES;

/// A part of a facet: its kind and the nodes of the facet that are its corners.
pub(crate) type Part = (CellKind, &'static [usize]);

/// The parts of a facet. Every node of the facet is a corner of one at least.
pub(crate) fn parts(kind: CellKind) -> &'static [Part] {
    match kind {
        CellKind::Line2 => &[(CellKind::Line2, &[0, 1])],
        CellKind::Tri3 => &[(CellKind::Tri3, &[0, 1, 2])],
        CellKind::Quad4 => &[(CellKind::Quad4, &[0, 1, 2, 3])],
        CellKind::Line3 => &[(CellKind::Line2, &[0, 2]), (CellKind::Line2, &[2, 1])],
        CellKind::Tri6 => &[
            (CellKind::Tri3, &[0, 3, 5]),
            (CellKind::Tri3, &[3, 1, 4]),
            (CellKind::Tri3, &[5, 4, 2]),
            (CellKind::Tri3, &[3, 4, 5]),
        ],
        CellKind::Quad8 => &[
            (CellKind::Tri3, &[0, 4, 7]),
            (CellKind::Tri3, &[1, 5, 4]),
            (CellKind::Tri3, &[2, 6, 5]),
            (CellKind::Tri3, &[3, 7, 6]),
            (CellKind::Quad4, &[4, 5, 6, 7]),
        ],
        CellKind::Quad9 => &[
            (CellKind::Quad4, &[0, 4, 8, 7]),
            (CellKind::Quad4, &[4, 1, 5, 8]),
            (CellKind::Quad4, &[8, 5, 2, 6]),
            (CellKind::Quad4, &[7, 8, 6, 3]),
        ],
        CellKind::Tet4 | CellKind::Tet10 | CellKind::Hex8 | CellKind::Hex20 | CellKind::Hex27 => &[],
        CellKind::Wedge6 | CellKind::Wedge15 => &[],
    }
}

/// Whether the reference domain is a triangle.
pub(crate) fn is_triangle(kind: CellKind) -> bool {
    matches!(kind, CellKind::Tri3 | CellKind::Tri6)
}
