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
/// `facets` are all that are as close, in ascending order.
pub(crate) fn faced<const D: usize>(
    facets: &[Projected<D>],
    outward: &Vector<D>,
    margin: f64,
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
        let better = |b: &Projected<D>| {
            p.distance < b.distance - tie || (p.distance <= b.distance + tie && decides(p.gap, b.gap))
        };
        if best.is_none_or(better) {
            best = Some(p);
        }
    }
    best.map(|p| p.facet)
}
