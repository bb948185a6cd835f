//! The reference domains of what points are projected on, and steps to the minimum of a function there.

use carom_mesh::CellKind;

use crate::tolerances::SEARCH;

/// Where the coordinates ξ of a facet, or of a tile of a smooth surface, are.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Domain {
    /// From −1 to 1.
    Segment,
    /// Between (0, 0), (1, 0) and (0, 1).
    Triangle,
    /// From −1 to 1 in both coordinates.
    Square,
}

/// A quadratic model of a function of ξ: its slope, and the symmetric matrix (11, 12, 22) of its second derivatives.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Quadratic {
    pub slope: [f64; 2],
    pub bend: [f64; 3],
}

impl Domain {
    /// That of a facet.
    pub fn of(kind: CellKind) -> Self {
        match kind.corner_count() {
            2 => Self::Segment,
            3 => Self::Triangle,
            _ => Self::Square,
        }
    }

    /// Its corners, in order.
    pub fn corners(self) -> &'static [[f64; 2]] {
        match self {
            Self::Segment => &[[-1.0, 0.0], [1.0, 0.0]],
            Self::Triangle => &[[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]],
            Self::Square => &[[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]],
        }
    }

    /// Its middle.
    pub fn middle(self) -> [f64; 2] {
        if self == Self::Triangle { [1.0 / 3.0; 2] } else { [0.0; 2] }
    }

    /// Whether ξ is in it.
    pub fn holds(self, xi: [f64; 2]) -> bool {
        match self {
            Self::Triangle => xi[0] >= 0.0 && xi[1] >= 0.0 && xi[0] + xi[1] <= 1.0,
            _ => xi.iter().all(|x| x.abs() <= 1.0),
        }
    }

    /// How far ξ is from an edge of a triangle or square, which goes from a corner to the next, as a fraction of what the domain is
    /// wide there; negative outside.
    pub fn inside_of(self, edge: usize, xi: &[f64; 2]) -> f64 {
        let along = self.along(edge);
        let corners = self.corners();
        let cross = |x: &[f64; 2]| {
            let from = [x[0] - corners[edge][0], x[1] - corners[edge][1]];
            along[0] * from[1] - along[1] * from[0]
        };
        cross(xi) / cross(&corners[(edge + 2) % corners.len()])
    }

    /// From the first to the second corner of an edge.
    pub fn along(self, edge: usize) -> [f64; 2] {
        let corners = self.corners();
        let (a, b) = (corners[edge], corners[(edge + 1) % corners.len()]);
        [b[0] - a[0], b[1] - a[1]]
    }

    /// The point of an edge at this fraction of its length.
    pub fn on_edge(self, edge: usize, fraction: f64) -> [f64; 2] {
        let (a, along) = (self.corners()[edge], self.along(edge));
        [a[0] + fraction * along[0], a[1] + fraction * along[1]]
    }

    /// The closest point, component by component, of what reaches beyond the domain by half its width.
    pub fn reached(self, mut xi: [f64; 2]) -> [f64; 2] {
        if self != Self::Triangle {
            let end = 1.0 + 2.0 * SEARCH.beyond;
            return xi.map(|x| x.clamp(-end, end));
        }
        xi = xi.map(|x| x.max(-SEARCH.beyond));
        let sum = 1.0 + SEARCH.beyond;
        let excess = xi[0] + xi[1] - sum;
        if excess > 0.0 {
            xi[0] = (xi[0] - 0.5 * excess).clamp(-SEARCH.beyond, sum + SEARCH.beyond);
            xi[1] = sum - xi[0];
        }
        xi
    }

    /// The step from ξ to the minimum over the domain of a convex quadratic model there; `None` where it has no minimum.
    pub fn step(self, xi: &[f64; 2], model: &Quadratic) -> Option<[f64; 2]> {
        let Quadratic { slope: g, bend: h } = model;
        if self == Self::Segment {
            let step = -g[0] / h[0];
            return step.is_finite().then(|| [(xi[0] + step).clamp(-1.0, 1.0) - xi[0], 0.0]);
        }
        let det = h[0] * h[2] - h[1] * h[1];
        let free = [(h[1] * g[1] - h[2] * g[0]) / det, (h[1] * g[0] - h[0] * g[1]) / det];
        if det > 0.0 && self.holds([xi[0] + free[0], xi[1] + free[1]]) {
            return Some(free);
        }
        // The minimum is on an edge.
        let mut best: Option<(f64, [f64; 2])> = None;
        for (k, a) in self.corners().iter().enumerate() {
            let (from, along) = ([a[0] - xi[0], a[1] - xi[1]], self.along(k));
            let h_along = [h[0] * along[0] + h[1] * along[1], h[1] * along[0] + h[2] * along[1]];
            let bend = along[0] * h_along[0] + along[1] * h_along[1];
            let slope = g[0] * along[0] + g[1] * along[1] + from[0] * h_along[0] + from[1] * h_along[1];
            let s = if bend > 0.0 { (-slope / bend).clamp(0.0, 1.0) } else { f64::from(slope < 0.0) };
            let step = [from[0] + s * along[0], from[1] + s * along[1]];
            let value = g[0] * step[0]
                + g[1] * step[1]
                + 0.5 * (h[0] * step[0] * step[0] + h[2] * step[1] * step[1])
                + h[1] * step[0] * step[1];
            if value.is_finite() && best.is_none_or(|(v, _)| value < v) {
                best = Some((value, step));
            }
        }
        best.map(|(_, step)| step)
    }
}
