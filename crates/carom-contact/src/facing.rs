//! Which of the facets around it a node faces.

use carom_mesh::Vector;

use crate::project::Projection;
use crate::tolerances::SEARCH;

/// A facet near a node, in the eyes of the node.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Projected<const D: usize> {
    pub facet: u32,
    /// Size of the box in which the facet finds nodes [m].
    size: f64,
    /// The closest point of the facet [m].
    point: Vector<D>,
    /// Outward unit normal there.
    normal: Vector<D>,
    /// From the closest point to the node [m].
    offset: Vector<D>,
    /// Its length [m].
    pub distance: f64,
    /// How far the node is in front of the facet, along the normal [m].
    pub gap: f64,
}

impl<const D: usize> Projected<D> {
    pub fn new(facet: u32, size: f64, x: &Vector<D>, p: &Projection<'_, D>) -> Self {
        let offset = x - p.point;
        let gap = p.normal.dot(&offset);
        Self { facet, size, point: p.point, normal: p.normal, offset, distance: offset.norm(), gap }
    }

    /// Whether the facet looks towards a node with this `outward` normal; a point without one looks everywhere.
    pub fn faces(&self, outward: &Vector<D>) -> bool {
        self.normal.dot(outward) < 0.0 || outward.norm_squared() == 0.0
    }

    /// Whether the node is in front of the facet, rather than beside it, or straight behind it.
    ///
    /// In front of a convex edge a node may stand as far beside either facet as before it. But a node behind and beside a facet
    /// is next to the body.
    pub fn is_square(&self) -> bool {
        let beside = (self.offset - self.normal * self.gap).norm();
        beside <= self.gap.max(0.0) + SEARCH.aligned * self.size
    }

    /// Whether the node is straight behind the facet.
    fn is_behind(&self) -> bool {
        self.gap < 0.0 && self.distance <= -self.gap + SEARCH.aligned * self.size
    }

    /// Of a facet and an `other`, both of which the node is straight behind, whether it came in through this one. `before` tells how far in
    /// front of a facet it started [m]. It came in through the plane that it was behind last. A node that started on both goes
    /// through the one that looks more towards its `outward` normal. None if that decides nothing.
    ///
    /// The closer of the two would be the wrong one for a node that a step presses through one side of a corner, next to the other side.
    fn is_entered(&self, other: &Self, outward: &Vector<D>, before: impl Fn(u32) -> f64) -> Option<bool> {
        if !self.is_behind() || !other.is_behind() {
            return None;
        }
        let tie = SEARCH.tie * self.size.max(other.size);
        let [own, others] = [self, other].map(|p| before(p.facet));
        // The part of its way on which it was in front.
        let part = |before: f64, p: &Self| before.max(0.0) / (before.max(0.0) - p.gap);
        match [own, others].map(|before| before.abs() <= tie) {
            [true, true] => {
                let [own, others] = [self, other].map(|p| -p.normal.dot(outward) / outward.norm());
                ((own - others).abs() > SEARCH.aligned).then_some(own > others)
            }
            _ if own < -tie && others < -tie => None,
            _ => Some(part(own, self) > part(others, other)),
        }
    }

    /// Whether the node is before an edge or corner, farther in front of this facet than of the others there, although still farther
    /// beside it. So there is no hole between the facets before corners in space, and before sharp edges. Likewise behind concave
    /// edges. All such places lie in the cone of the normals there.
    fn is_foremost(&self, facets: &[Self]) -> bool {
        let aligned = SEARCH.aligned * self.size;
        let around = || facets.iter().filter(|o| (o.point - self.point).norm() <= aligned);
        let mean = around().fold(Vector::zeros(), |sum, o| sum + o.normal).try_normalize(0.0);
        let limit = if self.gap > 0.0 { self.gap } else { 0.0 };
        let opening = |mean: Vector<D>| {
            let widest = around().map(|o| o.normal.dot(&mean)).fold(1.0, f64::min);
            self.offset.dot(&mean) * self.gap.signum() >= widest * self.distance - aligned
        };
        around().all(|o| o.gap <= limit) && mean.is_some_and(opening)
    }
}

/// The facet that a node with this `outward` normal faces: the closest of those that look towards it and come within `margin` [m].
///
/// `facets` are all that are as close, in ascending order; `before` tells how far in front of one the node started [m].
pub(crate) fn faced<const D: usize>(
    facets: &[Projected<D>],
    outward: &Vector<D>,
    margin: f64,
    before: impl Fn(u32) -> f64,
) -> Option<u32> {
    let mut best: Option<&Projected<D>> = None;
    for p in facets {
        if !p.faces(outward) || p.gap > margin || !(p.is_square() || p.is_foremost(facets)) {
            continue;
        }
        // Facets that share the closest point: before a convex edge the one that the node is farthest in front of, behind a concave
        // one, where both sides have to hold, the one that it is deepest behind.
        let tie = SEARCH.tie * p.size;
        let decides = |gap: f64, other: f64| if gap.max(other) > 0.0 { gap > other } else { gap < other };
        let closer = |b: &Projected<D>| {
            p.distance < b.distance - tie || (p.distance <= b.distance + tie && decides(p.gap, b.gap))
        };
        let better = |b: &Projected<D>| p.is_entered(b, outward, &before).unwrap_or_else(|| closer(b));
        if best.is_none_or(better) {
            best = Some(p);
        }
    }
    best.map(|p| p.facet)
}
