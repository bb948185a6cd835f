use super::quadratic::EDGES;
use super::{CellKind, Reference};

/// The triangle below and that above, the middles of the edges of both, then those of the upright edges.
const NODES: [[f64; 3]; 15] = [
    [0.0, 0.0, -1.0],
    [1.0, 0.0, -1.0],
    [0.0, 1.0, -1.0],
    [0.0, 0.0, 1.0],
    [1.0, 0.0, 1.0],
    [0.0, 1.0, 1.0],
    [0.5, 0.0, -1.0],
    [0.5, 0.5, -1.0],
    [0.0, 0.5, -1.0],
    [0.5, 0.0, 1.0],
    [0.5, 0.5, 1.0],
    [0.0, 0.5, 1.0],
    [0.0, 0.0, 0.0],
    [1.0, 0.0, 0.0],
    [0.0, 1.0, 0.0],
];

/// Gradients of the area coordinates of the triangle.
const SLOPES: [[f64; 2]; 3] = [[-1.0, -1.0], [1.0, 0.0], [0.0, 1.0]];

#[inline]
fn area(xi: &[f64; 3]) -> [f64; 3] {
    [1.0 - xi[0] - xi[1], xi[0], xi[1]]
}

/// Triangle 0 ≤ ξ, η, ξ + η ≤ 1 swept through −1 ≤ ζ ≤ 1.
pub(super) static WEDGE6: Reference = Reference {
    name: "wedge6",
    dimension: 3,
    degree: 1,
    nodes: NODES.split_at(6).0,
    facets: &[
        (CellKind::Tri3, &[0, 2, 1]),
        (CellKind::Tri3, &[3, 4, 5]),
        (CellKind::Quad4, &[0, 1, 4, 3]),
        (CellKind::Quad4, &[1, 2, 5, 4]),
        (CellKind::Quad4, &[2, 0, 3, 5]),
    ],
    shape: |xi, n| {
        let l = area(xi);
        for a in 0..3 {
            n[a] = 0.5 * l[a] * (1.0 - xi[2]);
            n[a + 3] = 0.5 * l[a] * (1.0 + xi[2]);
        }
    },
    gradient: |xi, g| {
        let l = area(xi);
        for a in 0..3 {
            let (below, above) = (0.5 * (1.0 - xi[2]), 0.5 * (1.0 + xi[2]));
            g[a] = [SLOPES[a][0] * below, SLOPES[a][1] * below, -0.5 * l[a]];
            g[a + 3] = [SLOPES[a][0] * above, SLOPES[a][1] * above, 0.5 * l[a]];
        }
    },
    vtk_type: 13,
};

/// Nodes at the corners and on the edges. With s = ±1 above and below, corners have ½ L ((2L − 1)(1 + sζ) − (1 − ζ²)). The edges
/// of the triangles have 2 L_i L_j (1 + sζ), and the upright ones L (1 − ζ²).
pub(super) static WEDGE15: Reference = Reference {
    name: "wedge15",
    dimension: 3,
    degree: 2,
    nodes: &NODES,
    facets: &[
        (CellKind::Tri6, &[0, 2, 1, 8, 7, 6]),
        (CellKind::Tri6, &[3, 4, 5, 9, 10, 11]),
        (CellKind::Quad8, &[0, 1, 4, 3, 6, 13, 9, 12]),
        (CellKind::Quad8, &[1, 2, 5, 4, 7, 14, 10, 13]),
        (CellKind::Quad8, &[2, 0, 3, 5, 8, 12, 11, 14]),
    ],
    shape: |xi, n| {
        let (l, bubble) = (area(xi), 1.0 - xi[2] * xi[2]);
        for (k, s) in [-1.0, 1.0].into_iter().enumerate() {
            let along = 1.0 + s * xi[2];
            for a in 0..3 {
                n[3 * k + a] = 0.5 * l[a] * ((2.0 * l[a] - 1.0) * along - bubble);
                let [i, j] = EDGES[a];
                n[6 + 3 * k + a] = 2.0 * l[i] * l[j] * along;
            }
        }
        for a in 0..3 {
            n[12 + a] = l[a] * bubble;
        }
    },
    gradient: |xi, g| {
        let (l, bubble) = (area(xi), 1.0 - xi[2] * xi[2]);
        for (k, s) in [-1.0, 1.0].into_iter().enumerate() {
            let along = 1.0 + s * xi[2];
            for a in 0..3 {
                let [i, j] = EDGES[a];
                for x in 0..2 {
                    g[3 * k + a][x] = 0.5 * SLOPES[a][x] * ((4.0 * l[a] - 1.0) * along - bubble);
                    g[6 + 3 * k + a][x] = 2.0 * (SLOPES[i][x] * l[j] + l[i] * SLOPES[j][x]) * along;
                }
                g[3 * k + a][2] = 0.5 * l[a] * ((2.0 * l[a] - 1.0) * s + 2.0 * xi[2]);
                g[6 + 3 * k + a][2] = 2.0 * l[i] * l[j] * s;
            }
        }
        for a in 0..3 {
            g[12 + a] = [SLOPES[a][0] * bubble, SLOPES[a][1] * bubble, -2.0 * l[a] * xi[2]];
        }
    },
    vtk_type: 26,
};
