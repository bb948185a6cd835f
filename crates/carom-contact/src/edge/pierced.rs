//! Edges that go through others.

use super::crossing::is_foremost;
use super::{Crossing, SurfaceEdge};
use crate::Path;
use crate::tolerances::{EDGES, SEARCH};

/// Two edges that have gone through one another by the end of a path.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Pierced {
    /// That of the source, and that of the target so that their vector product points to the source.
    pub edges: [[u32; 2]; 2],
    /// How far the one is behind the other then [m].
    pub depth: f64,
}

impl Pierced {
    /// The edges of a source and of a target, flat ones too, if the one is behind the other at the end, and farther than at the start, where
    /// the surfaces would touch with them.
    pub fn of<const D: usize>(
        source: SurfaceEdge<'_>,
        target: SurfaceEdge<'_>,
        path: &Path<'_, D>,
    ) -> Option<Self> {
        let [s, t] = [source.edge, target.edge];
        let [a, b] = [s, t].map(|edge| edge.line(path.start));
        let start = Crossing::new(&a, &b);
        let end = Crossing::new(&s.line(path.end), &t.line(path.end));
        let [on_s, on_t] = start.along;
        let (normals, opposite) = (target.normals(on_t, path.start), source.normals(on_s, path.start));
        let sign = if start.normal.dot(&(normals[0] + normals[1])) > 0.0 { 1.0 } else { -1.0 };
        let n = start.normal * sign;
        let crosses = start.sine.min(end.sine) >= EDGES.parallel
            && end.reach().into_iter().all(|reach| reach >= -EDGES.round_off)
            && start.normal.dot(&end.normal) > 0.0;
        // Behind what is farther inside, edges are on the other side of a wall.
        let deepest = -SEARCH.depth * a.chord().norm().min(b.chord().norm());
        let goes_in = end.gap * sign < (start.gap * sign).min(0.0) && end.gap * sign > deepest;
        if !crosses
            || !goes_in
            || !is_foremost(&n, &b.slope(on_t), &normals)
            || !is_foremost(&-n, &a.slope(on_s), &opposite)
        {
            return None;
        }
        let [from, to] = t.nodes;
        let edges = [s.nodes, if sign > 0.0 { [from, to] } else { [to, from] }];
        Some(Self { edges, depth: -end.gap * sign })
    }

    /// The one of the two that is less deep; of equal ones that with the lower nodes.
    pub fn shallower(self, other: Self) -> Self {
        let is_other = self.depth.total_cmp(&other.depth).then(self.edges.cmp(&other.edges)).is_gt();
        if is_other { other } else { self }
    }
}
