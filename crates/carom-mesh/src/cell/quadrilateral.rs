use super::{CellKind, Reference};

const NODES: [[f64; 3]; 4] = [[-1.0, -1.0, 0.0], [1.0, -1.0, 0.0], [1.0, 1.0, 0.0], [-1.0, 1.0, 0.0]];

/// Square −1 ≤ ξ, η ≤ 1.
pub(super) static QUAD4: Reference = Reference {
    name: "quad4",
    dimension: 2,
    nodes: &NODES,
    facets: &[
        (CellKind::Line2, &[0, 1]),
        (CellKind::Line2, &[1, 2]),
        (CellKind::Line2, &[2, 3]),
        (CellKind::Line2, &[3, 0]),
    ],
    shape: |xi, n| {
        for (n, p) in n.iter_mut().zip(&NODES) {
            *n = 0.25 * (1.0 + p[0] * xi[0]) * (1.0 + p[1] * xi[1]);
        }
    },
    gradient: |xi, g| {
        for (g, p) in g.iter_mut().zip(&NODES) {
            g[0] = 0.25 * p[0] * (1.0 + p[1] * xi[1]);
            g[1] = 0.25 * p[1] * (1.0 + p[0] * xi[0]);
        }
    },
    vtk_type: 9,
};
