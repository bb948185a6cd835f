use super::quadratic::{self, EDGES};
use super::{CellKind, Reference};

/// Triangle 0 ≤ ξ, η, ξ + η ≤ 1.
pub(super) static TRI3: Reference = Reference {
    name: "tri3",
    dimension: 2,
    degree: 1,
    nodes: &[[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]],
    facets: &[(CellKind::Line2, &[0, 1]), (CellKind::Line2, &[1, 2]), (CellKind::Line2, &[2, 0])],
    shape: |xi, n| {
        n[0] = 1.0 - xi[0] - xi[1];
        n[1] = xi[0];
        n[2] = xi[1];
    },
    gradient: |_, g| {
        g[0] = [-1.0, -1.0, 0.0];
        g[1] = [1.0, 0.0, 0.0];
        g[2] = [0.0, 1.0, 0.0];
    },
    vtk_type: 5,
};

/// The corners, then the middles of the edges.
pub(super) static TRI6: Reference = Reference {
    name: "tri6",
    dimension: 2,
    degree: 2,
    nodes: &[
        [0.0, 0.0, 0.0],
        [1.0, 0.0, 0.0],
        [0.0, 1.0, 0.0],
        [0.5, 0.0, 0.0],
        [0.5, 0.5, 0.0],
        [0.0, 0.5, 0.0],
    ],
    facets: &[(CellKind::Line3, &[0, 1, 3]), (CellKind::Line3, &[1, 2, 4]), (CellKind::Line3, &[2, 0, 5])],
    shape: |xi, n| quadratic::simplex(&EDGES[..3], 2, xi, n),
    gradient: |xi, g| quadratic::simplex_gradient(&EDGES[..3], 2, xi, g),
    vtk_type: 22,
};
