use super::{CellKind, Reference, quadratic};

/// The corners, the middles of the edges, the centre.
const NODES: [[f64; 3]; 9] = [
    [-1.0, -1.0, 0.0],
    [1.0, -1.0, 0.0],
    [1.0, 1.0, 0.0],
    [-1.0, 1.0, 0.0],
    [0.0, -1.0, 0.0],
    [1.0, 0.0, 0.0],
    [0.0, 1.0, 0.0],
    [-1.0, 0.0, 0.0],
    [0.0, 0.0, 0.0],
];

const QUADRATIC_EDGES: &[(CellKind, &[usize])] = &[
    (CellKind::Line3, &[0, 1, 4]),
    (CellKind::Line3, &[1, 2, 5]),
    (CellKind::Line3, &[2, 3, 6]),
    (CellKind::Line3, &[3, 0, 7]),
];

/// Square −1 ≤ ξ, η ≤ 1.
pub(super) static QUAD4: Reference = Reference {
    name: "quad4",
    dimension: 2,
    degree: 1,
    nodes: NODES.split_at(4).0,
    facets: &[
        (CellKind::Line2, &[0, 1]),
        (CellKind::Line2, &[1, 2]),
        (CellKind::Line2, &[2, 3]),
        (CellKind::Line2, &[3, 0]),
    ],
    shape: |xi, n| {
        for (n, p) in n.iter_mut().zip(&NODES[..4]) {
            *n = 0.25 * (1.0 + p[0] * xi[0]) * (1.0 + p[1] * xi[1]);
        }
    },
    gradient: |xi, g| {
        for (g, p) in g.iter_mut().zip(&NODES[..4]) {
            g[0] = 0.25 * p[0] * (1.0 + p[1] * xi[1]);
            g[1] = 0.25 * p[1] * (1.0 + p[0] * xi[0]);
        }
    },
    vtk_type: 9,
};

/// Without a node at the centre.
pub(super) static QUAD8: Reference = Reference {
    name: "quad8",
    dimension: 2,
    degree: 2,
    nodes: NODES.split_at(8).0,
    facets: QUADRATIC_EDGES,
    shape: |xi, n| quadratic::serendipity(&NODES[..8], 2, xi, n),
    gradient: |xi, g| quadratic::serendipity_gradient(&NODES[..8], 2, xi, g),
    vtk_type: 23,
};

/// With a node at the centre.
pub(super) static QUAD9: Reference = Reference {
    name: "quad9",
    dimension: 2,
    degree: 2,
    nodes: &NODES,
    facets: QUADRATIC_EDGES,
    shape: |xi, n| quadratic::product(&NODES, 2, xi, n),
    gradient: |xi, g| quadratic::product_gradient(&NODES, 2, xi, g),
    vtk_type: 28,
};
