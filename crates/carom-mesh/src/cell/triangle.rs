use super::{CellKind, Reference};

/// Triangle 0 ≤ ξ, η, ξ + η ≤ 1.
pub(super) static TRI3: Reference = Reference {
    name: "tri3",
    dimension: 2,
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
