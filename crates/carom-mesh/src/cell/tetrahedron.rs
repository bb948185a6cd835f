use super::quadratic::{self, EDGES};
use super::{CellKind, Reference};

/// Tetrahedron 0 ≤ ξ, η, ζ, ξ + η + ζ ≤ 1.
pub(super) static TET4: Reference = Reference {
    name: "tet4",
    dimension: 3,
    degree: 1,
    nodes: &[[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
    facets: &[
        (CellKind::Tri3, &[0, 2, 1]),
        (CellKind::Tri3, &[0, 1, 3]),
        (CellKind::Tri3, &[1, 2, 3]),
        (CellKind::Tri3, &[0, 3, 2]),
    ],
    shape: |xi, n| {
        n[0] = 1.0 - xi[0] - xi[1] - xi[2];
        n[1] = xi[0];
        n[2] = xi[1];
        n[3] = xi[2];
    },
    gradient: |_, g| {
        g[0] = [-1.0, -1.0, -1.0];
        g[1] = [1.0, 0.0, 0.0];
        g[2] = [0.0, 1.0, 0.0];
        g[3] = [0.0, 0.0, 1.0];
    },
    vtk_type: 10,
};

/// The corners, then the middles of the edges.
pub(super) static TET10: Reference = Reference {
    name: "tet10",
    dimension: 3,
    degree: 2,
    nodes: &[
        [0.0, 0.0, 0.0],
        [1.0, 0.0, 0.0],
        [0.0, 1.0, 0.0],
        [0.0, 0.0, 1.0],
        [0.5, 0.0, 0.0],
        [0.5, 0.5, 0.0],
        [0.0, 0.5, 0.0],
        [0.0, 0.0, 0.5],
        [0.5, 0.0, 0.5],
        [0.0, 0.5, 0.5],
    ],
    facets: &[
        (CellKind::Tri6, &[0, 2, 1, 6, 5, 4]),
        (CellKind::Tri6, &[0, 1, 3, 4, 8, 7]),
        (CellKind::Tri6, &[1, 2, 3, 5, 9, 8]),
        (CellKind::Tri6, &[0, 3, 2, 7, 9, 6]),
    ],
    shape: |xi, n| quadratic::simplex(&EDGES, 3, xi, n),
    gradient: |xi, g| quadratic::simplex_gradient(&EDGES, 3, xi, g),
    vtk_type: 24,
};
