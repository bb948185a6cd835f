use super::{CellKind, Reference};

const NODES: [[f64; 3]; 8] = [
    [-1.0, -1.0, -1.0],
    [1.0, -1.0, -1.0],
    [1.0, 1.0, -1.0],
    [-1.0, 1.0, -1.0],
    [-1.0, -1.0, 1.0],
    [1.0, -1.0, 1.0],
    [1.0, 1.0, 1.0],
    [-1.0, 1.0, 1.0],
];

/// Cube −1 ≤ ξ, η, ζ ≤ 1.
pub(super) static HEX8: Reference = Reference {
    name: "hex8",
    dimension: 3,
    nodes: &NODES,
    facets: &[
        (CellKind::Quad4, &[0, 3, 2, 1]),
        (CellKind::Quad4, &[4, 5, 6, 7]),
        (CellKind::Quad4, &[0, 1, 5, 4]),
        (CellKind::Quad4, &[1, 2, 6, 5]),
        (CellKind::Quad4, &[2, 3, 7, 6]),
        (CellKind::Quad4, &[3, 0, 4, 7]),
    ],
    shape: |xi, n| {
        for (n, p) in n.iter_mut().zip(&NODES) {
            *n = 0.125 * (1.0 + p[0] * xi[0]) * (1.0 + p[1] * xi[1]) * (1.0 + p[2] * xi[2]);
        }
    },
    gradient: |xi, g| {
        for (g, p) in g.iter_mut().zip(&NODES) {
            let f = [1.0 + p[0] * xi[0], 1.0 + p[1] * xi[1], 1.0 + p[2] * xi[2]];
            g[0] = 0.125 * p[0] * f[1] * f[2];
            g[1] = 0.125 * p[1] * f[0] * f[2];
            g[2] = 0.125 * p[2] * f[0] * f[1];
        }
    },
    vtk_type: 12,
};
