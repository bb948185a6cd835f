//! How facets are taken apart for integration: into parts with straight edges, on which multipliers are linear.

use carom_mesh::CellKind;

/// The most nodes of a facet.
pub(super) const MAX_FACET_NODES: usize = 9;

/// A part of a facet: its kind and the nodes of the facet that are its corners.
pub(super) type Part = (CellKind, &'static [usize]);

/// The parts of a facet. Every node of the facet is a corner of one at least.
pub(super) fn parts(kind: CellKind) -> &'static [Part] {
    match kind {
        CellKind::Line2 => &[(CellKind::Line2, &[0, 1])],
        CellKind::Tri3 => &[(CellKind::Tri3, &[0, 1, 2])],
        CellKind::Quad4 => &[(CellKind::Quad4, &[0, 1, 2, 3])],
        CellKind::Tet4 | CellKind::Hex8 => &[],
    }
}

/// Whether the reference domain is a triangle.
pub(super) fn is_triangle(kind: CellKind) -> bool {
    kind == CellKind::Tri3
}

/// Number of corners, which are the first nodes.
pub(super) fn corner_count(kind: CellKind) -> usize {
    parts(kind)[0].1.len()
}
