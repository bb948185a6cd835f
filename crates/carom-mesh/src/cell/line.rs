use super::{CellKind, Reference, quadratic};

const NODES: [[f64; 3]; 3] = [[-1.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 0.0]];

/// Segment −1 ≤ ξ ≤ 1.
pub(super) static LINE2: Reference = Reference {
    name: "line2",
    dimension: 1,
    degree: 1,
    nodes: NODES.first_chunk::<2>().expect("two ends"),
    facets: &[] as &[(CellKind, &[usize])],
    shape: |xi, n| {
        n[0] = 0.5 * (1.0 - xi[0]);
        n[1] = 0.5 * (1.0 + xi[0]);
    },
    gradient: |_, g| {
        g[0][0] = -0.5;
        g[1][0] = 0.5;
    },
    vtk_type: 3,
};

/// The ends, then the middle.
pub(super) static LINE3: Reference = Reference {
    name: "line3",
    dimension: 1,
    degree: 2,
    nodes: &NODES,
    facets: &[],
    shape: |xi, n| quadratic::product(&NODES, 1, xi, n),
    gradient: |xi, g| quadratic::product_gradient(&NODES, 1, xi, g),
    vtk_type: 21,
};
