//! Which facets of its own surface a node never touches.

use crate::aabb::Aabb;
use crate::bvh::Bvh;
use crate::edge::Edge;
use crate::path::Positions;
use crate::project::Reach;
use crate::surface::diameter;
use crate::tolerances::SEARCH;
use crate::{ContactModel, ContactSurface, Target};

impl ContactSurface {
    /// The same boundary as one whose nodes may touch its own facets.
    ///
    /// A node never touches the facets around it and those next to these. Nor does it touch, through the body, facets that it is
    /// close behind in the `reference` configuration [m]: those of the other side of a thin wall. All others it may touch if it
    /// faces them.
    #[must_use]
    pub fn touching_itself<const D: usize>(mut self, reference: &Positions<'_, D>) -> Self {
        let facets = 0..self.facets.len() as u32;
        let room = |f: u32| {
            let facet = self.bounds(f, reference);
            facet.inflated(SEARCH.wall * facet.diameter())
        };
        let tree = Bvh::new(facets.map(room));
        let never = |&node: &u32| {
            let mut never = self.next_to(node);
            let x = reference(node);
            tree.overlapping(&Aabb::of([x]), |f, _| {
                let p = self.project(f, &x, Reach::Facet, reference);
                let is_near =
                    (x - p.point).norm() <= SEARCH.wall * diameter(&self.facets[f as usize], reference);
                if is_near && p.normal.dot(&(x - p.point)) < 0.0 {
                    never.push(f);
                }
            });
            never.sort_unstable();
            never.dedup();
            never
        };
        self.never_touched = self.sources.iter().map(never).collect();
        self
    }

    /// The facets around a source, and those that share a node with them.
    fn next_to(&self, node: u32) -> Vec<u32> {
        let around = self.around(node);
        let nodes = around.iter().flat_map(|&f| &self.facets[f as usize].nodes);
        around.iter().chain(nodes.flat_map(|&n| self.around(n))).copied().collect()
    }

    /// Whether two edges of this surface may touch: the ends of either the facets beside the other.
    pub(crate) fn edges_may_touch(&self, edge: &Edge, other: &Edge) -> bool {
        let source = |n: u32| self.sources.binary_search(&self.master(n)).ok();
        let may = |n: u32, edge: &Edge| {
            source(n).is_some_and(|k| edge.facets().all(|f| self.may_touch_itself(k, f)))
        };
        edge.nodes.into_iter().all(|n| may(n, other)) && other.nodes.into_iter().all(|n| may(n, edge))
    }

    /// Whether the source number `k` may touch the facet `f` of its own surface.
    #[inline]
    pub(crate) fn may_touch_itself(&self, k: usize, f: u32) -> bool {
        self.never_touched.get(k).is_some_and(|never| never.binary_search(&f).is_err())
    }
}

impl<const D: usize> ContactModel<D> {
    /// Whether a pair is that of a surface with itself.
    #[must_use]
    pub fn is_self_contact(&self, pair: usize) -> bool {
        let pair = self.pairs.get(pair);
        pair.target == Target::Surface(pair.source)
    }
}
