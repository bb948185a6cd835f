use super::{CellKind, Reference};

/// Segment −1 ≤ ξ ≤ 1.
pub(super) static LINE2: Reference = Reference {
    name: "line2",
    dimension: 1,
    nodes: &[[-1.0, 0.0, 0.0], [1.0, 0.0, 0.0]],
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
