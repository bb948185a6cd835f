use super::{CellKind, Reference, quadratic};

/// The corners; the middles of the edges below, above and upright; those of the sides left, right, front, back, below and
/// above; the centre.
const NODES: [[f64; 3]; 27] = [
    [-1.0, -1.0, -1.0],
    [1.0, -1.0, -1.0],
    [1.0, 1.0, -1.0],
    [-1.0, 1.0, -1.0],
    [-1.0, -1.0, 1.0],
    [1.0, -1.0, 1.0],
    [1.0, 1.0, 1.0],
    [-1.0, 1.0, 1.0],
    [0.0, -1.0, -1.0],
    [1.0, 0.0, -1.0],
    [0.0, 1.0, -1.0],
    [-1.0, 0.0, -1.0],
    [0.0, -1.0, 1.0],
    [1.0, 0.0, 1.0],
    [0.0, 1.0, 1.0],
    [-1.0, 0.0, 1.0],
    [-1.0, -1.0, 0.0],
    [1.0, -1.0, 0.0],
    [1.0, 1.0, 0.0],
    [-1.0, 1.0, 0.0],
    [-1.0, 0.0, 0.0],
    [1.0, 0.0, 0.0],
    [0.0, -1.0, 0.0],
    [0.0, 1.0, 0.0],
    [0.0, 0.0, -1.0],
    [0.0, 0.0, 1.0],
    [0.0, 0.0, 0.0],
];

/// Cube −1 ≤ ξ, η, ζ ≤ 1.
pub(super) static HEX8: Reference = Reference {
    name: "hex8",
    dimension: 3,
    degree: 1,
    nodes: NODES.split_at(8).0,
    facets: &[
        (CellKind::Quad4, &[0, 3, 2, 1]),
        (CellKind::Quad4, &[4, 5, 6, 7]),
        (CellKind::Quad4, &[0, 1, 5, 4]),
        (CellKind::Quad4, &[1, 2, 6, 5]),
        (CellKind::Quad4, &[2, 3, 7, 6]),
        (CellKind::Quad4, &[3, 0, 4, 7]),
    ],
    shape: |xi, n| {
        for (n, p) in n.iter_mut().zip(&NODES[..8]) {
            *n = 0.125 * (1.0 + p[0] * xi[0]) * (1.0 + p[1] * xi[1]) * (1.0 + p[2] * xi[2]);
        }
    },
    gradient: |xi, g| {
        for (g, p) in g.iter_mut().zip(&NODES[..8]) {
            let f = [1.0 + p[0] * xi[0], 1.0 + p[1] * xi[1], 1.0 + p[2] * xi[2]];
            g[0] = 0.125 * p[0] * f[1] * f[2];
            g[1] = 0.125 * p[1] * f[0] * f[2];
            g[2] = 0.125 * p[2] * f[0] * f[1];
        }
    },
    vtk_type: 12,
};

/// Nodes at the corners and on the edges.
pub(super) static HEX20: Reference = Reference {
    name: "hex20",
    dimension: 3,
    degree: 2,
    nodes: NODES.split_at(20).0,
    facets: &[
        (CellKind::Quad8, &[0, 3, 2, 1, 11, 10, 9, 8]),
        (CellKind::Quad8, &[4, 5, 6, 7, 12, 13, 14, 15]),
        (CellKind::Quad8, &[0, 1, 5, 4, 8, 17, 12, 16]),
        (CellKind::Quad8, &[1, 2, 6, 5, 9, 18, 13, 17]),
        (CellKind::Quad8, &[2, 3, 7, 6, 10, 19, 14, 18]),
        (CellKind::Quad8, &[3, 0, 4, 7, 11, 16, 15, 19]),
    ],
    shape: |xi, n| quadratic::serendipity(&NODES[..20], 3, xi, n),
    gradient: |xi, g| quadratic::serendipity_gradient(&NODES[..20], 3, xi, g),
    vtk_type: 25,
};

/// Nodes at the corners, on the edges, on the sides and at the centre.
pub(super) static HEX27: Reference = Reference {
    name: "hex27",
    dimension: 3,
    degree: 2,
    nodes: &NODES,
    facets: &[
        (CellKind::Quad9, &[0, 3, 2, 1, 11, 10, 9, 8, 24]),
        (CellKind::Quad9, &[4, 5, 6, 7, 12, 13, 14, 15, 25]),
        (CellKind::Quad9, &[0, 1, 5, 4, 8, 17, 12, 16, 22]),
        (CellKind::Quad9, &[1, 2, 6, 5, 9, 18, 13, 17, 21]),
        (CellKind::Quad9, &[2, 3, 7, 6, 10, 19, 14, 18, 23]),
        (CellKind::Quad9, &[3, 0, 4, 7, 11, 16, 15, 19, 20]),
    ],
    shape: |xi, n| quadratic::product(&NODES, 3, xi, n),
    gradient: |xi, g| quadratic::product_gradient(&NODES, 3, xi, g),
    vtk_type: 29,
};
